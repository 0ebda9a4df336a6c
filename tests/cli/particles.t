#!/bin/sh
# particles: numbers, places, sizes, density grids, and what is refused.
# Seeds are fixed; with others a statistical test would fail by chance less than once in 1e5.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"

# Numbers are cut to ten digits: the last ones of the radii are the mathematical library's.
text() { tabtxt | awk -F'\t' 'NR == 1 { print; next } { for (i = 1; i <= NF; i++) printf("%s%.10g", i > 1 ? "\t" : "", $i); print "" }'; }
rows() { tabtxt | sed 1d | wc -l; }

# npy TYPE SHAPE [ORDER]: the header of a .npy file; the data follow.
npy() {
	header="{'descr': '$1', 'fortran_order': ${3:-False}, 'shape': ($2), }"
	length=$(( (${#header} + 1 + 10 + 63) / 64 * 64 - 10 ))
	printf '\223NUMPY\001\000'
	# shellcheck disable=SC2059
	printf "\\$(printf %o $((length & 255)))\\$(printf %o $((length >> 8)))"
	printf "%-$((length - 1))s\n" "$header"
}
f4() { perl -e 'print pack "f<*", @ARGV' -- "$@"; }
f8() { perl -e 'print pack "d<*", @ARGV' -- "$@"; }

psd lognormal --median 10um --gsd 1.3 -o p.tab
printf '# radius:f64:um\tweight:f64:1\n1\t1\n2\t0\n3\t3\n4\t0\n' | txttab >w.tab

# -------- numbers
particles --psd p.tab --count 20 --box 1m,2m,20cm | text >few
golden particles.txt few
is 12345 "$(particles --psd p.tab --count 12345 --sphere 1m | rows)" '--count is exact in a sphere'
is '# x:f32:m	y:f32:m	z:f32:m	radius:f64:um	class:i32:1' "$(particles --psd p.tab --count 1 --sphere 1m | tabtxt | head -1)" 'the columns'
is 0 "$(particles --psd p.tab --concentration 0/m3 --sphere 1m | rows)" 'concentration 0'
is 1 "$(particles --psd p.tab --concentration 1e11/m3 --box 1cm,1cm,1cm | rows | awk '{ print ($1 - 1e5)^2 < 1e5 * 4.5^2 }')" \
	'Poisson: a hundred thousand, within 4.5 standard deviations'
is 1 "$(particles --psd p.tab --concentration 5e4/cm3 --sphere 1cm | rows | awk '{ m = 2e5 * 3.14159265358979 / 3; print ($1 - m)^2 < m * 4.5^2 }')" \
	'Poisson in a sphere: concentration times its volume'
for seed in $(seq 1 300); do particles --psd w.tab --concentration 0.1/m3 --box 1m,1m,1m --seed "$seed" | rows; done >rare
is 1 "$(awk '{ n += $1 } END { print (n - 30)^2 < 30 * 4.5^2 }' rare)" 'Poisson: a mean of 0.1'
is 2 "$(particles --psd p.tab --count 3 --sphere 1m --seed 7 | tabtxt -o a; particles --psd p.tab --count 3 --sphere 1m --seed 8 | tabtxt | diff - a | grep -c '^[<>]' | awk '{ print $1 == 6 ? 2 : $1 }')" \
	'another seed, other particles'
particles --psd p.tab --count 1e3 --sphere 1m --seed 7 | tabtxt | sed -n '2,4p' >b
sed 1d a | cmp -s - b
ok $? 'the first particles do not depend on how many there are'
particles --psd p.tab --count 1000 --box 1m,1m,1m -o c.tab
particles --box 1m,1m,1m --psd - --count 1000 <p.tab | cmp -s - c.tab
is 1 $? 'the order of options is in the history ...'
particles --psd - --count 1000 --box 1m,1m,1m <p.tab | cmp -s - c.tab
ok $? '... but no file name'
is 'psd lognormal --median 10um --gsd 1.3
particles --count 1000 --box 1m,1m,1m' "$(sed -n 's/^cmd	//p' c.tab)" 'history'

# -------- places
particles --psd w.tab --count 2e5 --box 2m,20cm,2mm -o box.tab
# 1000 cells: chi-square has 999 degrees of freedom, standard deviation 44.7; 1200 is 4.5 of them.
tabtxt box.tab | sed 1d >box.txt
is 1 "$(awk '
	$1 < -1 || $1 > 1 || $2 < -.1 || $2 > .1 || $3 < -.001 || $3 > .001 { out++ }
	{ n[int(($1 + 1) * 5) + 10 * int(($2 + .1) * 50) + 100 * int(($3 + .001) * 5000)]++ }
	END { for (i = 0; i < 1000; i++) chi += (n[i] - 200)^2 / 200; print (!out && chi < 1200 && chi > 820) }' box.txt)" 'a box is filled evenly, and nothing is outside'
is 1 "$(particles --psd w.tab --count 1e5 --sphere 2cm | tabtxt | sed 1d | awk '
	{ r = sqrt($1^2 + $2^2 + $3^2) / 0.02; if (r > 1.0000001) out++; n[int(r^3 * 100)]++; up += $2 > 0; right += $1 > 0 }
	END { for (i = 0; i < 100; i++) chi += (n[i] - 1000)^2 / 1000; print !out && chi < 172 && (up - 5e4)^2 < 5e5 && (right - 5e4)^2 < 5e5 }')" 'a sphere is filled evenly'
is 1 "$(awk '{ n[$5]++; if ($4 != $5 + 1) bad++ }
	END { print !bad && n[0] + n[2] == 200000 && (n[0] - 50000)^2 < 37500 * 4.5^2 }' box.txt)" 'classes by weight; a class without weight has no particles'

# -------- densities
{ npy '|u1' '1, 1, 2'; printf '\000\377'; } >u1.npy
{ npy '<f4' '1, 1, 2'; f4 0 1; } >f4.npy
{ npy '<f8' '1, 1, 2'; f8 0 1; } >f8.npy
for t in u1 f4 f8; do particles --psd w.tab --count 1e4 --box 2m,1m,1m --density $t.npy --seed 3 | tabtxt >$t.txt; done
cmp -s u1.txt f4.txt && cmp -s f8.txt f4.txt
ok $? 'u1, f4 and f8 are the same density'
# Density 0 for x < -1/2, 1/2 + x up to 1/2, then 1: a quarter of the particles lies below 1/2 of [-1/2, 1/2], one in eight below 0.
is 1 "$(sed 1d f4.txt | awk '$1 < -.5 { out++ } $1 < 0 { low++ } $1 < .5 { mid++ }
	END { print !out && (low - 1250)^2 < 1094 * 4.5^2 && (mid - 5000)^2 < 2500 * 4.5^2 }')" 'density is linear between the centres, constant beyond'
{ npy '<f4' '2, 1, 1'; f4 0 2; } >z.npy
is 1 "$(particles --psd w.tab --concentration 1e4/m3 --box 1m,1m,2m --density z.npy | tabtxt | sed 1d | awk '$3 < -.5 { out++ } { n++ }
	END { print !out && (n - 20000)^2 < 20000 * 4.5^2 }')" 'z is the first index; concentration times volume times mean density'
{ npy '<f4' '1, 2, 1'; f4 0 1; } >y.npy
is 1 "$(particles --psd w.tab --concentration 1e4/m3 --sphere 1m --density y.npy | tabtxt | sed 1d | awk '$2 < -.5 { out++ } { n++ }
	END { m = 2e4 * 3.14159265358979 / 3; print !out && (n - m)^2 < m * 4.5^2 }')" 'a density in a sphere: half of the volume by symmetry'
{ printf '\223NUMPY\002\000'; npy '<f4' '1, 1, 2' | tail -c +9 | perl -0777 -pe 's/^(..)/$1\0\0/s'; f4 0 1; } >v2.npy
particles --psd w.tab --count 1e4 --box 2m,1m,1m --density v2.npy --seed 3 | tabtxt | cmp -s - f4.txt
ok $? 'version 2 of the format'

# -------- refused
p() { particles --psd w.tab "$@"; }
refused 'no distribution' '^particles: --psd: needed' particles --count 1 --sphere 1m
refused 'neither count nor concentration' '^particles: --count: give either' p --sphere 1m
refused 'both count and concentration' '^particles: --count: give either' p --sphere 1m --count 1 --concentration 1/m3
refused 'neither box nor sphere' '^particles: --box: give either' p --count 1
refused 'both box and sphere' '^particles: --box: give either' p --count 1 --box 1m,1m,1m --sphere 1m
refused 'a box without a unit' "^particles: --box: '1,1,1' is a length without a unit" p --count 1 --box 1,1,1
refused 'a flat box' '^particles: --box: .* out of range' p --count 1 --box 1m,0m,1m
refused 'a box of NaN' '^particles: --box: ' p --count 1 --box nanm,1m,1m
refused 'a concentration without a unit' '^particles: --concentration: .* without a unit' p --concentration 1e6 --sphere 1m
refused 'half a particle' "^particles: --count: '1.5' is not a whole number" p --count 1.5 --sphere 1m
refused 'no particle' '^particles: --count: .* out of range' p --count 0 --sphere 1m
refused 'too many' '^particles: --concentration: makes more than 1e\+12' p --concentration 1e12/cm3 --sphere 1m
refused 'an operand' '^particles: w.tab: no operands' particles w.tab
refused 'a table that is not there' '^particles: none.tab: ' particles --psd none.tab --count 1 --sphere 1m
tab() { printf '%b' "$1" | txttab >t.tab; }
refuse_tab() { tab "$3"; refused "$1" "$2" particles --psd t.tab --count 1 --sphere 1m; }
refuse_tab 'no radius' 'particles: t.tab: .*radius' '# weight:f64:1\n1\n'
refuse_tab 'no weight' 'particles: t.tab: .*weight' '# radius:f64:um\n1\n'
refuse_tab 'a radius in m' 'particles: t.tab: .*radius.*um' '# radius:f64:m\tweight:f64:1\n1\t1\n'
refuse_tab 'a radius that is NaN' 'particles: t.tab: row 2: a radius is greater than 0, not nan' '# radius:f64:um\tweight:f64:1\n1\t1\nnan\t1\n'
refuse_tab 'a weight that is NaN' 'particles: t.tab: row 1: a weight is at least 0, not -?nan' '# radius:f64:um\tweight:f64:1\n1\tnan\n'
refuse_tab 'a negative weight' 'particles: t.tab: row 1: a weight is at least 0, not -1' '# radius:f64:um\tweight:f64:1\n1\t-1\n'
refuse_tab 'no class' 'particles: t.tab: has no class' '# radius:f64:um\tweight:f64:1\n'
refuse_tab 'no weight in any class' 'particles: t.tab: has no class' '# radius:f64:um\tweight:f64:1\n1\t0\n'
head -c -1 p.tab >cut.tab
refused 'a table cut short' '^particles: cut.tab: ' particles --psd cut.tab --count 1 --sphere 1m

d() { p --count 1 --box 1m,1m,1m --density t.npy; }
{ npy '<f4' '1, 1, 2' True; f4 0 1; } >t.npy; refused 'Fortran order' '^particles: t.npy: is in Fortran order' d
{ npy '>f4' '1, 1, 2'; f4 0 1; } >t.npy; refused 'big-endian' "^particles: t.npy: has type '>f4'" d
{ npy '<i8' '1, 1, 1'; f8 1; } >t.npy; refused 'integers' "^particles: t.npy: has type '<i8'" d
{ npy '<f4' '1, 2'; f4 0 1; } >t.npy; refused 'two dimensions' '^particles: t.npy: has 2 dimensions' d
{ npy '<f4' '1, 0, 2'; } >t.npy; refused 'no voxels' '^particles: t.npy: is an empty array' d
{ npy '<f4' '4294967296, 4294967296, 4294967296'; f4 1; } >t.npy; refused 'a huge shape' '^particles: t.npy: has too many voxels' d
{ npy '<f4' '4000, 4000, 4000'; f4 1; } >t.npy; refused 'a large shape without the data' '^particles: t.npy: the array is cut short' d
{ npy '<f4' '1, 1, 2'; f4 0 1 2; } >t.npy; refused 'bytes left over' '^particles: t.npy: has bytes after' d
{ npy '<f4' '1, 1, 2'; f4 1 -1; } >t.npy; refused 'a negative density' '^particles: t.npy: voxel \[0\]\[0\]\[1\]' d
{ npy '<f4' '1, 2, 1'; f4 1 nan; } >t.npy; refused 'NaN' '^particles: t.npy: voxel \[0\]\[1\]\[0\]' d
{ npy '<f8' '2, 1, 1'; f8 1 1e300; } >t.npy; refused 'infinity as a float' '^particles: t.npy: voxel \[1\]\[0\]\[0\]' d
{ npy '<f4' '1, 1, 2'; f4 0 0; } >t.npy; refused 'no density anywhere' '^particles: t.npy: is 0 everywhere' d
printf 'P5 1 1 255\nxxxxxxxxxx' >t.npy; refused 'another format' '^particles: t.npy: is not a NumPy array' d

# A file cut short at every third byte, and every byte of the header in turn changed: one line and exit 2, or a table, but nothing else.
failures=0
size=$(wc -c <f4.npy)
for n in $(seq 0 3 $((size - 1))); do
	head -c "$n" f4.npy >t.npy
	d >out 2>err
	[ $? -eq 2 ] && [ "$(wc -l <err)" -eq 1 ] && ! [ -s out ] || failures=$((failures + 1))
done
is 0 $failures 'a grid cut short anywhere is refused'
failures=0
for n in $(seq 0 127); do
	perl -0777 -pe 'BEGIN { $n = shift } substr($_, $n, 1) = chr(ord(substr($_, $n, 1)) ^ (1 << $n % 8))' "$n" f4.npy >t.npy
	d >out 2>err
	status=$?
	{ [ $status -eq 0 ] && [ -s out ] && ! [ -s err ]; } || { [ $status -eq 2 ] && [ "$(wc -l <err)" -eq 1 ] && ! [ -s out ]; } || failures=$((failures + 1))
done
is 0 $failures 'a damaged header is refused or does not matter'
done_testing
