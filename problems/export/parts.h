// SPDX-License-Identifier: MIT
//
// Parts of the C header, of which @ becomes the name that is asked for, and $ the same in capitals.
#ifndef PROBLEMS_EXPORT_PARTS_H
#define PROBLEMS_EXPORT_PARTS_H

extern const char *const export_arithmetic[],
    *const export_gait[], *const export_steer[], *const export_heading[],
                                                     *const export_heading_law[],
                                                         *const export_path_law[],
                                                             *const export_plan_law[]; // [lines], NULL at the end

#endif
