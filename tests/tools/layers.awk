# layers.awk - checks every #include "..." of src/ against src/layers.txt, its first argument.
# A file of methods/A must not include anything of methods/B.

function room(path,   parts) { split(path, parts, "/"); return parts[1] }

FNR == 1 { file = FILENAME; sub(/^src\//, "", file) }

NR == FNR {
    if ($0 !~ /^#/ && split($0, side, ":") == 2) {
        known[side[1]] = 1
        count = split(side[2], names, " ")
        for (i = 1; i <= count; i++) allowed[side[1], names[i]] = 1
    }
    next
}

/^[ \t]*#[ \t]*include[ \t]*"/ {
    target = $0
    sub(/^[^"]*"/, "", target)
    sub(/".*/, "", target)
    if (target ~ /^assay\//) next
    from = room(file)
    to = target ~ /\// ? room(target) : from
    if (!(from in known)) { print file ": room '" from "' is not in src/layers.txt"; bad++; next }
    if (to != from && !((from, to) in allowed)) {
        print file ":" FNR ": includes \"" target "\", which its layer may not see"; bad++
    }
    if (from == "methods" && to == "methods") {
        a = file; sub(/^methods\//, "", a); b = target; sub(/^methods\//, "", b)
        if (a ~ /\// && b ~ /\// && room(a) != room(b)) {
            print file ":" FNR ": a method includes another method"; bad++
        }
    }
    checked++
}

END { if (bad) exit 1; print "layers: " checked " includes, all as src/layers.txt says" }
