// SPDX-License-Identifier: MIT
#ifndef SRC_SNAKE_MODEL_LINKS_H
#define SRC_SNAKE_MODEL_LINKS_H

#include "moray/snake/model.h"

// Of every link where they are not equal. Error: MORAY_INPUT naming the link, its field, value and what is allowed.
moray_status moray_links_check(const moray_robot *robot);

#endif
