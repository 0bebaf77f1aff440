// SPDX-License-Identifier: MIT
#include "tap.h"

#include "moray/app/program.h"

int main(void)
{
    CHECK(moray_exit_of(MORAY_OK) == 0 && moray_exit_of(MORAY_NOT_SOLVED) == 1 && moray_exit_of(MORAY_NUMERIC) == 1 &&
              moray_exit_of(MORAY_MEMORY) == 1 && moray_exit_of(MORAY_INPUT) == 2 && moray_exit_of(MORAY_IO) == 2 &&
              moray_exit_of(MORAY_INTERRUPTED) == 130,
          "exit codes");
    return tap_done();
}
