#!/bin/sh
# SPDX-License-Identifier: MIT
# Intervals of 95 % of identify over many synthetic logs, of the first-principles and the consistent model: the truths lie
# inside them in 93 to 97 % of the seeds, and errors weighed by the claimed covariance add up as chi^2 does.
# Takes minutes and runs by name alone:  sh tests/studies/identify.sh BUILD_FOLDER [SEEDS]
exec "$1/tests/test_identify" "${2:-200}"
