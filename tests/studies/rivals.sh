#!/bin/sh
# SPDX-License-Identifier: MIT
# Heading feedback as the programs tune it against an independent search, Nelder and Mead's simplex from twenty starts, on
# the sine of 30 deg and 60 s and on Fig. 8: five laws, each within 5 % of the simplex and none worse than its subset.
# Takes minutes and runs by name alone:  sh tests/studies/rivals.sh BUILD_FOLDER
exec "$1/tests/test_rivals" all
