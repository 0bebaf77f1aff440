// SPDX-License-Identifier: MIT
//
// Takes a gait, and a law of steering with its gains, home to a robot: tables for its controller, a C header that needs
// nothing, and the robot itself for other simulators.
#include "export/export.h"

int main(int argc, char **argv)
{
    static export_job job; // large
    static export_found found;
    int exit_code;
    job = export_defaults();
    if (!moray_app_start(&export_program, argc, argv, &job, &exit_code))
        return exit_code;
    moray_status status = export_gather(&found, &job);
    if (!moray_failed(status))
        status = export_report(&found);
    export_release(&found);
    return moray_app_end(&export_program, &job, status);
}
