# SPDX-License-Identifier: MIT
# No room includes what stands above it. What a room may include is what its library links (src/ROOM/meson.build), itself and what those link; public
# headers belong to rooms, too. Arguments: the source directory.
root=$1
. "$root/tests/tap.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$root" || exit 1

# allowed: "ROOM LOWER" for every room that a room's library links, and itself.
allowed() {
    find src -name meson.build | while read -r build; do
        room=${build#src/}
        room=${room%/meson.build}
        echo "$room $room"
        tr '\n' ' ' <"$build" | grep -o 'link_with: \[[^]]*\]' | grep -o '[a-z_]*_lib' |
            sed "s|_lib$||; s|^snake_|snake/|; s|^|$room |"
        # A library of its own, on the whole of the other.
        ! grep -q 'link_with: libmoray,' "$build" || printf '%s\n' "$room base" "$room options" "$room results"
    done
}

# public_headers: "HEADER ROOM" for every public header; a header without a room is told.
public_headers() {
    find include/moray -name '*.h' | while read -r path; do
        header=${path#include/}
        case $header in
        moray/moray.h | moray/snake.h) continue ;;
        moray/export.h | moray/status.h | moray/key_value.h | moray/num.h | moray/angle.h | moray/map.h | moray/casadi.h | moray/clock.h | moray/number.h | moray/dense.h | moray/ode.h | moray/parallel.h | moray/table.h | moray/water.h) room=base ;;
        moray/nlp.h | moray/search.h) room=nlp ;;
        moray/delay.h | moray/fit.h | moray/ocp.h | moray/scheme.h | moray/sensitivity.h) room=ocp ;;
        moray/sim.h) room=sim ;;
        moray/control/*) room=control ;;
        moray/app/options.h) room=options ;;
        moray/app/results.h) room=results ;;
        moray/app/sweep.h) room=sweep ;;
        moray/app/*) room=run ;;
        moray/snake/model.h | moray/snake/motor.h) room=snake/model ;;
        moray/snake/plant.h) room=snake/plant ;;
        moray/snake/gait_problem.h | moray/snake/gait_search.h | moray/snake/gait_over.h) room=snake/gait ;;
        moray/snake/steering.h | moray/snake/heading.h | moray/snake/heading_law.h | moray/snake/instruments.h | moray/snake/navigator.h | moray/snake/moving_horizon.h | moray/snake/poincare.h | moray/snake/robust.h | moray/snake/path.h | moray/snake/turn.h | moray/snake/controllers.h | \
            moray/snake/closed_loop.h | moray/snake/receding_horizon.h) room=snake/steer ;;
        moray/snake/identify.h) room=snake/identify ;;
        moray/snake/*) room=snake/swim ;;
        *) room=none ;;
        esac
        echo "$header $room"
    done
}

# includes: "FILE ROOM HEADER" for every include of ours, of sources and of public headers.
includes() {
    while read -r header room; do
        sed -n 's/^#include ["<]\(moray\/[^">]*\)[">].*/\1/p' "include/$header" | sed "s|^|include/$header $room |"
    done <"$work/headers"
    find src -name '*.[ch]' -o -name '*.inc' | while read -r file; do
        sed -n 's/^#include "\([^"]*\)".*/\1/p' "$file" | sed "s|^|$file $(dirname "${file#src/}") |"
    done
}

# upward: the includes that no rule allows.
upward() {
    awk -v headers="$work/headers" -v allowed="$work/allowed" '
        function room(path) { # the room that a path lies in, at whatever depth
            while (!((path " " path) in may) && sub(/\/[^\/]*$/, "", path))
                continue
            return path
        }
        BEGIN {
            while ((getline line < headers) > 0) { split(line, part, " "); room_of[part[1]] = part[2] }
            while ((getline line < allowed) > 0) may[line] = 1
        }
        {
            from = room($2)
            to = $3 in room_of ? room_of[$3] : room($3)
            if (!((from " " to) in may)) print $1 " (" from ") includes " $3 " (" to ")"
        }' "$@"
}

public_headers >"$work/headers"
allowed >"$work/allowed"
includes >"$work/includes"
upward "$work/includes" >"$work/upward"
check "every public header has its room" eval '[ -s "$work/headers" ] && ! grep -q " none$" "$work/headers"'
check "$(wc -l <"$work/includes") includes, $(wc -l <"$work/upward") of them upward" eval '[ -s "$work/includes" ] && [ ! -s "$work/upward" ]'
sed 's/^/# /' "$work/upward"
# The rule itself, on what it must refuse and let pass.
echo "src/ocp/x.c ocp moray/snake/model.h" | upward >"$work/refused"
check "a robot in ocp would be told" [ -s "$work/refused" ]
echo "src/options/x.c options moray/snake/options.h" | upward >"$work/refused"
check "so would one in options" [ -s "$work/refused" ]
echo "src/base/x.c base ocp/layout.h" | upward >"$work/refused"
check "and a private header of a higher room" [ -s "$work/refused" ]
echo "src/ocp/x.c ocp base/csv.h" | upward >"$work/refused"
check "a lower one passes" [ ! -s "$work/refused" ]
check "no general room links a robot's" eval \
    '! grep -E "^(base|linear|nlp|ocp|sim|control|options|results|run) snake" "$work/allowed"'
tap_done
