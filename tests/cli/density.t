#!/bin/sh
# What vrender makes of a medium unless told otherwise: a density that varies is seen as it varies.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"
# shellcheck source=tests/support/render.sh
. "$top/tests/support/render.sh"

# half a cube: nothing at x < 0, twice the density at x > 0
perl -e 'printf "\x93NUMPY\1\0v\0%-117s\n", "{\x27descr\x27: \x27<f4\x27, \x27fortran_order\x27: False, \x27shape\x27: (1, 1, 2), }"; print pack "f<2", 0, 2' >half.npy
hg 0 >iso.phase
one_size
xsections '1e6 1e6' >one.xsect
bake() { medium-bake --xsect one.xsect --phase iso.phase --psd one.psd --concentration 1e6/m3 --box 2m,2m,2m "$@"; }
bake --density half.npy -o half.medium
bake -o even.medium
bake --voxels 4 -o voxels.medium
particles --psd one.psd --count 100 --box 2m,2m,2m | medium-bake --xsect one.xsect --phase iso.phase --box 2m,2m,2m -o grains.medium
# taken MEDIUM TRANSPORT: it is rendered so by default, bit by bit, and says so
taken() {
	scene s.scene "$1.medium" 16 'lights = ( { type = "sun"; direction = [-1, 0, 0]; irradiance = 2.0; } );'
	vrender s.scene --samples 4 --verbose -o default.exr 2>err
	vrender s.scene --samples 4 --transport "$2" -o asked.exr
	imgcmp --max 0 default.exr asked.exr >/dev/null && grep -q "$2, the default for" err
	ok $? "$1 is rendered as $2 unless told otherwise"
}
taken half grid
taken even continuous
taken voxels continuous
taken grains explicit

# ---- how far one sees: Koschmieder's extinction, ln(50) / 100 m, at 550 nm, between the wavelengths of the table or at the nearest
visible() {
	medium-bake --xsect "$1.xsect" --phase iso.phase --psd one.psd --visibility 100m --box 100m,200m,200m --verbose -o seen.medium 2>err &&
		grep -q "extinction of 0.03912/m" err && grep -q "$2" err
	ok $? "--visibility by $1: $(cat err)"
}
hg 0 0.45 0.5 0.55 0.6 >iso.phase
dispersed 1e6 1 0.5 0.6 >between.xsect
dispersed 1e6 1 0.6 >longer.xsect
visible one '100 m at 0.55 um where 39120.2/m3'
visible between '0.55 um where 37257.4/m3'
visible longer '0.6 um where 39120.2/m3'
grep -q '^medium-bake: --visibility: is taken at 0.6 um' err
ok $? 'which is said'
bake_host() { medium-bake --xsect one.xsect --phase iso.phase --psd one.psd --visibility 100m --host "$1" --box 100m,200m,200m --verbose -o hosted.medium 2>err; }
# 4 pi 1e-9 / 0.55 um is 0.0228479/m of ln(50) / 100 m
bake_host 1.33+1e-9i && grep -q 'where 16272.3/m3' err
ok $? "a host takes its part: $(cat err)"
bake_host 1.33+3e-9i
[ $? -eq 2 ] && grep -q 'farther than one sees in the host alone, 57.0733 m' err
ok $? "or all: $(cat err)"
scene s.scene seen.medium 16 ''
vrender s.scene --samples 1 --verbose -o s.exr 2>&1 | grep -q 'mean optical depth 3.912 '
ok $? 'an optical depth of 3.912 over 100 m'
for wrong in '--visibility 100m --concentration 1/m3' ''; do
	# shellcheck disable=SC2086
	medium-bake --xsect one.xsect --phase iso.phase --psd one.psd $wrong --box 1m,1m,1m -o no.medium 2>err
	[ $? -eq 2 ] && [ "$(wc -l <err)" -eq 1 ] && ! [ -e no.medium ]
	ok $? "refused: $(cat err)"
done
done_testing
