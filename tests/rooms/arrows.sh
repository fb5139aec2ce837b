#!/usr/bin/env bash
# Prints every include that tests/rooms/rooms.txt does not allow. Succeeds if there is none.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

grep -rnE --include='*.h' --include='*.cpp' --include='*.glsl' --include='*.comp' --include='*.vert' --include='*.frag' \
    '^[[:space:]]*#[[:space:]]*include "[^"]*/' footprints shaders engine apps python examples tests |
    awk '
    # The room of a path: the longest name that equals the path or is a folder above it.
    function room_of(path,    i, best) {
        best = ""
        for (i = 1; i <= rooms; ++i)
            if ((path == name[i] || index(path, name[i] "/") == 1) && length(name[i]) > length(best)) best = name[i]
        return best
    }
    # Whether the room `from` may include the room `to`: its list contains `to` or a folder above it.
    function allowed(from, to,    i, n, list) {
        if (from == to || (to in ground && order[to] < order[from])) return 1
        n = split(allows[from], list, " ")
        for (i = 1; i <= n; ++i)
            if (to == list[i] || index(to, list[i] "/") == 1) return 1
        return 0
    }
    BEGIN {
        while ((getline line < "tests/rooms/rooms.txt") > 0) {
            if (line ~ /^#/) continue
            split(line, halves, ":")
            room = halves[1]
            on_ground = room ~ /^\[/
            gsub(/[][]/, "", room)
            name[++rooms] = room
            order[room] = rooms
            allows[room] = halves[2]
            if (on_ground) ground[room]
            n = split(halves[2], list, " ")
            for (i = 1; i <= n; ++i)
                if (!(list[i] in order) && list[i] !~ /^(engine|shaders)$/) {
                    print "tests/rooms/rooms.txt: " room " names " list[i] ", expected a room above it"
                    wrong = 1
                }
        }
    }
    {
        file = $0
        sub(/:.*/, "", file)
        target = $0
        sub(/^[^"]*"/, "", target)
        sub(/".*/, "", target)
        from = room_of(file)
        to = room_of(target)
        if (from == "" || to == "" || !allowed(from, to)) {
            print file ": " target ", which " (from == "" ? "a file in no room of rooms.txt" : from) " may not include"
            wrong = 1
        }
    }
    END { exit wrong }'
