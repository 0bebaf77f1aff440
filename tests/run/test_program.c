// SPDX-License-Identifier: MIT
#include "tap.h"

#include "moray/app/program.h"

int main(void)
{
    CHECK(moray_exit_of(MORAY_OK) == 0 && moray_exit_of(MORAY_NOT_SOLVED) == 1 && moray_exit_of(MORAY_NUMERIC) == 1 &&
              moray_exit_of(MORAY_MEMORY) == 1 && moray_exit_of(MORAY_INPUT) == 2 && moray_exit_of(MORAY_IO) == 2 &&
              moray_exit_of(MORAY_INTERRUPTED) == 130,
          "exit codes");
    const moray_common common = moray_common_default();
    for (int code = MORAY_OK; code <= MORAY_INTERRUPTED; code++) {
        const moray_status status = code == MORAY_OK ? moray_ok() : moray_error((moray_code)code, "gnuplot is out");
        const bool ends = code == MORAY_MEMORY || code == MORAY_INTERRUPTED;
        CHECK((int)moray_app_drawn(&common, "test_program", status).code == (ends ? code : MORAY_OK),
              "a figure that is not drawn %s the program, code %d", ends ? "ends" : "does not end", code);
    }
    return tap_done();
}
