// SPDX-License-Identifier: MIT
#ifndef MORAY_STATUS_H
#define MORAY_STATUS_H

#include <stdbool.h>

#include "moray/export.h"

MORAY_BEGIN

// One list makes the enum and the texts.
#define MORAY_CODES(X)                                                                                                 \
    X(OK, "ok")                                                                                                        \
    X(INPUT, "bad input")                                                                                              \
    X(MEMORY, "out of memory")                                                                                         \
    X(IO, "cannot read or write")                                                                                      \
    X(NUMERIC, "numerical failure")                                                                                    \
    X(NOT_SOLVED, "not solved")                                                                                        \
    X(INTERRUPTED, "interrupted")

typedef enum {
#define MORAY_CODE_ENUM(name, text) MORAY_##name,
    MORAY_CODES(MORAY_CODE_ENUM)
#undef MORAY_CODE_ENUM
} moray_code;

// An error is a value: what kind, and one line that names the thing, its value and what is allowed. The text is the
// receiver's own copy; nothing to free.
typedef struct moray_status {
    moray_code code;
    char text[300];
} moray_status;

MORAY_API moray_status moray_ok(void);
MORAY_API moray_status moray_error(moray_code code, const char *format, ...) MORAY_PRINTF(2, 3);
MORAY_API const char *moray_code_text(moray_code code);

static inline bool moray_failed(moray_status status)
{
    return status.code != MORAY_OK;
}

// Returns the status of EXPRESSION from the calling function unless it is ok; only where nothing is owned yet.
#define MORAY_TRY(expression)                                                                                          \
    do {                                                                                                               \
        moray_status moray_try_ = (expression);                                                                        \
        if (moray_failed(moray_try_))                                                                                  \
            return moray_try_;                                                                                         \
    } while (0)

MORAY_END

#endif
