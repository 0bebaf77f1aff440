// SPDX-License-Identifier: MIT
//
// What stands around declarations: MORAY_API says that the library exports it (all else is hidden, so that no name of a
// program can take its place), MORAY_BEGIN and MORAY_END that it has C linkage in C++ too.
#ifndef MORAY_EXPORT_H
#define MORAY_EXPORT_H

#ifdef __GNUC__
#define MORAY_API __attribute__((visibility("default")))
#define MORAY_PRINTF(format_at, first) __attribute__((format(printf, format_at, first)))
#else
#define MORAY_API
#define MORAY_PRINTF(format_at, first)
#endif

#ifdef __cplusplus
#define MORAY_BEGIN extern "C" {
#define MORAY_END }
#else
#define MORAY_BEGIN
#define MORAY_END
#endif

#endif
