// SPDX-License-Identifier: MIT
#define _GNU_SOURCE // RTLD_DEFAULT
#include "run/versions.h"

#include <dlfcn.h>
#include <string.h>

#include "moray/app/results.h"
#include "nlp/ipopt_version.h"
#include "sim/sim_version.h"

// OpenBLAS tells what it is; another BLAS does not.
static const char *blas(void)
{
    const char *(*config)(void);
    void *found = dlsym(RTLD_DEFAULT, "openblas_get_config");
    memcpy(&config, &found, sizeof found);
    return found ? config() : "unknown";
}

moray_status moray_write_ini(const moray_common *common)
{
    FILE *file;
    char sundials[32];
    if (!common->ini)
        return moray_ok();
    MORAY_TRY(moray_output_file(common->output, "run.ini", &file));
    moray_sundials_version(sundials, sizeof sundials);
    fprintf(file, "%s\n; moray %s, Ipopt %s, SUNDIALS %s, BLAS: %s\n", common->ini, moray_version(),
            moray_ipopt_version, sundials, blas());
    return moray_ok();
}
