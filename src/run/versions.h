// SPDX-License-Identifier: MIT
//
// Inside the application layer: the settings of a run as a file, with what computed it.
#ifndef SRC_RUN_VERSIONS_H
#define SRC_RUN_VERSIONS_H

#include "moray/app/options.h"

// run.ini of --out; nothing where there are no settings. Error: those of moray_output_file.
moray_status moray_write_ini(const moray_common *common);

#endif
