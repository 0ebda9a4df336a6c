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
done_testing
