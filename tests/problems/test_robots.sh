# SPDX-License-Identifier: MIT
# Random robots of a few seeds, as tests/studies/robots.sh draws them: solved and certified, or refused for a reason that
# simulation does not contradict. Arguments: the folder of the build, the source directory.
build=$1
source=$2
set -- "$build/problems/max_speed" "$source"
. "$source/tests/program.sh"

# seeds FIRST LAST
seeds() {
    sh "$source/tests/studies/robots.sh" "$build" "$1" "$2" >out 2>err
    code=$?
    check "seeds $1 to $2, none refused without cause: $(grep 'can be done' out)" [ $code -eq 0 ]
    check "all that can be done are solved and certified" grep -q ', 100 %' out
}

# Seed 77 has 12 links in a current of 2 mm/s: a search for the fastest gait from the paper's alone comes to nothing.
seeds 77 77
seeds 5 7
tap_done
