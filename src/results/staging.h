// SPDX-License-Identifier: MIT
#ifndef SRC_RESULTS_STAGING_H
#define SRC_RESULTS_STAGING_H

// Makes the folder that `path` is a template of, as for mkdtemp ("DIR/.moray-XXXXXX"), and locks it. Returns 0 or
// errno.
int moray_staging_new(char *path, int *held);

// Removes it, empty, and gives up the lock.
void moray_staging_end(const char *path, int held);

// Removes those folders that runs have left in a directory which were killed; a run that is under way keeps its own.
void moray_staging_clear(const char *directory);

#endif
