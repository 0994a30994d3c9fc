#!/bin/sh
# shellcheck disable=SC2046,SC2086
# assay basis ...: options good and bad, tables, pictures, exit codes.  TAP.  What JSON holds:
# test_basis_json.c.
. tests/support/tap.sh

commands="eval table project convert rotate digon accuracy plot"

# ---- help ----
run basis
{ [ "$code" -eq 2 ] && [ ! -s "$folder/stdout" ] && grep -q usage "$folder/stderr"; }
result $? "no command: usage on stderr, exit code 2"
run basis --help
went_well && for command in $commands; do grep -q "^  $command " "$folder/stdout" || exit 1; done
result $? "basis --help lists all commands"
refuses "unknown command" 2 "frobnicate" basis frobnicate
refuses "an option without a command" 2 "--json" basis --json
for command in $commands; do
    run basis $command --help
    missing=$(sed -n 's/^.*{"\([a-z-]*\)", \(0\|.[a-z].\), .*/\1/p' src/cli/cmd_basis_$command.c |
        while read -r name; do grep -q -- "--$name" "$folder/stdout" || echo "$name"; done)
    went_well && [ -z "$missing" ]
    result $? "basis $command --help names every option of its table $missing"
    refuses "$command: nothing said" 2 "is missing" basis $command
    refuses "$command: unknown option" 2 "--frobnicate" basis $command --frobnicate x
    refuses "$command: an operand" 2 "no such argument" basis $command x
done

# ---- what is refused; WORD | ARGUMENTS ----
while IFS='|' read -r word arguments; do
    refuses "$arguments" 2 "$word" basis $arguments
done <<'TABLE'
no such basis|eval --basis fourier --order 3 --dir 0,0,1
--basis is missing|eval --order 3 --dir 0,0,1
--order is missing|eval --basis sh --dir 0,0,1
--dir or --theta-deg|eval --basis sh --order 3
not as both|eval --basis sh --order 3 --dir 0,0,1 --theta-deg 3
from 1 to 33|eval --basis sh --order 0 --dir 0,0,1
from 1 to 33|eval --basis sh --order 34 --dir 0,0,1
from 1 to 33|eval --basis sh --order -1 --dir 0,0,1
from 1 to 33|eval --basis sh --order 2.5 --dir 0,0,1
from 1 to 33|eval --basis sh --order= --dir 0,0,1
unit vector|eval --basis sh --order 3 --dir 0,0,2
unit vector|eval --basis sh --order 3 --dir 0,0,0
unit vector|eval --basis sh --order 3 --dir 1e200,0,0
z >= 0|eval --basis hsh --order 3 --dir 0,0.6,-0.8
z >= 0|eval --basis zernike --order 3 --theta-deg 91
three numbers|eval --basis sh --order 3 --dir nan,0,1
three numbers|eval --basis sh --order 3 --dir 0,1
takes a number|eval --basis sh --order 3 --theta-deg inf
takes thesis|eval --basis sh --order 3 --dir 0,0,1 --convention mine
kontkanen|eval --basis hsh --order 3 --dir 0,0,1 --convention kontkanen
kontkanen|eval --basis sh --order 4 --dir 0,0,1 --convention kontkanen
convention|eval --basis zernike --order 3 --dir 0,0,1 --convention plain
takes no value|eval --basis sh --order 3 --dir 0,0,1 --json=yes
whole number|table --basis sh --order 2 --theta-steps 0
whole number|table --basis sh --order 2 --phi-steps 65537
name it so|table --basis sh --order 2 -o x.png
--env or --lobe|project --basis sh --order 3
one thing at a time|project --env x.exr --lobe phong:5@0 --order 3
of --basis sh|project --env x.exr --basis hsh --order 3 --irradiance
in a hemispherical basis|project --env x.exr --order 3 --normal 0,1,0
in a hemispherical basis|project --lobe phong:5@0 --basis hsh --order 3 --normal 0,1,0
three numbers|project --env x.exr --basis hsh --order 3 --normal 0,1
--order is missing|project --env x.exr
--basis is missing|project --lobe phong:5@0 --order 3
--samples takes|project --lobe ward:0.5,0.5@89.999 --basis hsh --order 1
are of --lobe|project --env x.exr --order 3 --samples 9
one way at a time|project --lobe phong:5@0 --basis sh --order 3 --samples 9 --theta-nodes 5
--table-steps of --via table|rotate --basis hsh --via exact --order 2 --beta-deg 30 --table-steps 5
--sh-order is of --via conversion|rotate --basis hsh --order 2 --beta-deg 30 --sh-order 5
not of --output|table --basis hsh --order 2 -o t.npy --json
--irradiance is of --env|project --lobe phong:5@0 --basis sh --order 3 --irradiance
nowhere.exr|project --env nowhere.exr --order 3
phong:EXPONENT@THETA|project --lobe blinn:5@0 --basis sh --order 3
phong:EXPONENT@THETA|accuracy --lobe phong:5
phong:EXPONENT@THETA|accuracy --lobe phong:5,6@3
phong:EXPONENT@THETA|accuracy --lobe phong:x@3
phong:EXPONENT@THETA|accuracy --lobe ward:0.2@3
phong:EXPONENT@THETA|accuracy --lobe ward:0.2,0.5,1@3
phong:EXPONENT@THETA|accuracy --lobe ward:0.2,0.5@
phong:EXPONENT@THETA|accuracy --lobe ward@3
phong:EXPONENT@THETA|accuracy --lobe nan
[0, 90)|accuracy --lobe phong:5@90
[0, 90)|accuracy --lobe phong:5@-1
exponent is >= 0|accuracy --lobe phong:-5@0
a width > 0|accuracy --lobe ward:0,0.5@0
too close to the horizon|accuracy --lobe ward:0.5,0.5@89.999 --basis hsh --max-order 1
is 0 in double precision|accuracy --lobe ward:1e300,1e300@10 --basis hsh --max-order 2
is inf in double precision|accuracy --lobe ward:1e-200,1e-200@10 --basis hsh --max-order 2
too narrow or too weak|project --lobe ward:1e300,1e300@10 --basis hsh --order 2
from 1 to 33|accuracy --lobe phong:5@0 --max-order 34
singular|project --lobe phong:5@0 --basis lsosh --order 20
--from is missing|convert --to sh --order 3
--to is missing|convert --from sh --order 3
one basis sh and one hsh|convert --from sh --to sh --order 3
one basis sh and one hsh|convert --from zernike --to sh --order 3
from 1 to 33|convert --from hsh --to sh --order 3 --to-order 40
--euler-zyz-deg or --beta-deg|rotate --basis sh --order 3
says it all|rotate --basis sh --order 3 --beta-deg 3 --euler-zyz-deg 1,2,3
three numbers|rotate --basis sh --order 3 --euler-zyz-deg 1,2
rotations are known of|rotate --basis zernike --order 3 --beta-deg 3
of --basis hsh|rotate --basis sh --order 3 --beta-deg 3 --via digon
takes exact|rotate --basis hsh --order 3 --beta-deg 3 --via magic
beta|rotate --basis hsh --order 3 --beta-deg 91 --via analytical
beta|rotate --basis hsh --order 3 --beta-deg -91 --via digon
beta|rotate --basis hsh --order 3 --beta-deg 91 --via table
beta|rotate --basis hsh --order 3 --beta-deg 181
takes a number|rotate --basis hsh --order 3 --beta-deg nan
-180 to 180 degrees|digon --order 3 --beta-deg 200
takes thesis|convert --from sh --to hsh --order 3 --to-convention mine
kontkanen|convert --from hsh --to sh --order 4 --to-convention kontkanen
--beta-deg is missing|digon --order 3
-o F.png is missing|plot --basis hsh --l 2 --m 1
--basis is missing|plot --l 2 --m 1 -o x.png
no such function|plot --basis hsh --l 2 --m 3 -o x.png
no such function|plot --basis zernike --l 2 --m 1 -o x.png
0 to 32|plot --basis hsh --l 33 --m 1 -o x.png
name it so|plot --basis hsh --l 2 --m 1 -o x.exr
--lobe is missing|plot --accuracy -o x.png
draws all bases|plot --accuracy --lobe phong:5@0 --basis sh -o x.png
--lobe is of --accuracy|plot --basis hsh --l 2 --m 1 --lobe phong:5@0 -o x.png
64 to 2048|plot --basis hsh --l 2 --m 1 --size 10 -o x.png
300 pixels|plot --accuracy --lobe phong:5@0 --size 200 -o x.png
TABLE

# ---- tables ----
accepts "eval by angles" basis eval --basis makhotkin --order 3 --theta-deg 90 --phi-deg 20
accepts "eval at the pole" basis eval --basis sh --order 33 --dir 0,0,1
holds() { # NAME LINE ARGUMENT...: a line of the output, blanks squeezed
    name=$1 line=$2
    shift 2
    run "$@"
    went_well && tr -s ' ' < "$folder/stdout" | grep -qxF -- "$line"
    result $? "$name"
}
holds "eval: sqrt(3 / 4 pi)" " 2 1 0 0.48860251190291992" basis eval --basis sh --order 2 --dir 0,0,1
holds "eval: a hexadecimal float" " 0 0 0 0x1.20dd750429b6dp-2" \
    basis eval --basis sh --order 1 --dir 0,0,1 --hex
holds "convert: C[0][0] = 1 / sqrt(2), exact zeros" " 1,0 0 0 0.353553 0" \
    basis convert --from sh --to hsh --order 2
holds "rotate: 90 degrees about y move z to x" " 1,1 0 0 1.000000 0" \
    basis rotate --basis sh --order 2 --beta-deg 90 --convention plain
holds "digon: M[0][0] = 1 - beta / pi" " 0,0 0.833333" basis digon --order 1 --beta-deg 30
holds "accuracy: HSH hold z^5" " 6 1.000000000 ( 36)" \
    basis accuracy --lobe phong:5@0 --basis hsh --max-order 6
holds "convert: another sign and order on the other side" " 1,-1 0 -0.673872 0 0" \
    basis convert --from hsh --to sh --order 2 --to-convention kontkanen
holds "rotate: what is small is told from nothing" " 1,1 0 0 1.75e-10 1.000000" \
    basis rotate --basis sh --order 2 --beta-deg 1e-8 --convention plain
holds "accuracy: a needle" " 2 2e-300 ( 4)" \
    basis accuracy --lobe phong:2e300@10 --basis sh --max-order 2
run basis table --basis esh --order 3 --theta-steps 2 --phi-steps 4
went_well && [ "$(wc -l < "$folder/stdout")" -eq 13 ]
result $? "table: a line a direction"
accepts "table as .npy" basis table --basis hsh --order 3 -o "$out/t.npy"
[ "$(wc -c < "$out/t.npy")" -eq $((128 + 8 * 7 * 8 * 12)) ]
result $? "table as .npy: 56 directions of 12 numbers"
clear_out
for way in exact table conversion digon analytical; do
    accepts "rotate hsh via $way" basis rotate --basis hsh --via $way --order 3 --beta-deg 20
    accepts "rotate hsh via $way, any axis" basis rotate --basis hsh --via $way --order 3 \
        --euler-zyz-deg 10,20,-30
done
accepts "rotate hsh via conversion, of another order" basis rotate --basis hsh --via conversion \
    --order 3 --sh-order 8 --beta-deg 20

# ---- projections of a map ----
accepts "a map" render $box --size 16x8 --spp 1 -o "$folder/map.exr"
for options in "" "--irradiance" "--rotation-deg 30" "--convention plain" "--json" "--hex"; do
    accepts "project --env $options" basis project --env "$folder/map.exr" --order 4 $options
done
for normal in 0,0,1 0,1,0 0.6,0,-0.8; do
    accepts "project --env on the hemisphere about $normal" \
        basis project --env "$folder/map.exr" --basis hsh --order 4 --normal $normal
done
refuses "a normal that is none" 2 "unit vector" \
    basis project --env "$folder/map.exr" --basis hsh --order 4 --normal 0,1,1
for options in "" "--samples 1000 --seed 3" "--theta-nodes 16 --phi-nodes 16"; do
    accepts "project --lobe $options" basis project --lobe ward:0.2,0.5@30,45 --basis lsosh \
        --order 4 $options
done
run basis project --lobe phong:5@30 --basis hsh --order 4 --samples 1000 --json
cp "$folder/stdout" "$folder/first"
run basis project --lobe phong:5@30 --basis hsh --order 4 --samples 1000 --seed 0 --json
cmp -s "$folder/stdout" "$folder/first"
result $? "the same seed, the same numbers"
run basis project --lobe phong:5@30 --basis hsh --order 4 --samples 1000 --seed 1 --json
! cmp -s "$folder/stdout" "$folder/first"
result $? "another seed, other numbers"

# ---- pictures ----
is_png() { [ "$(head -c 4 "$1" | tail -c 3)" = PNG ]; }
accepts "plot of a function" basis plot --basis hsh --l 2 --m 1 --size 128 -o "$out/a.png"
is_png "$out/a.png"
result $? "it is a PNG"
accepts "the same again" basis plot --basis hsh --l 2 --m 1 --size 128 -o "$out/b.png"
cmp -s "$out/a.png" "$out/b.png"
result $? "it is the same picture"
accepts "plot of accuracies" basis plot --accuracy --lobe phong:5@30 --max-order 4 -o "$out/c.png"
is_png "$out/c.png"
result $? "it is a PNG"
clear_out
refuses "plot: folder is missing" 3 "nowhere" basis plot --basis sh --l 0 --m 0 -o "$out/nowhere/x"
refuses "table: folder is missing" 3 "nowhere" basis table --basis sh --order 1 -o "$out/nowhere/x"
finish
