#!/bin/sh
# One medium, three ways: continuous, a grid of constant density, a grid that counts 10^7 particles.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"
# shellcheck source=tests/support/media.sh
. "$top/tests/support/media.sh"
clouds_setup
sed -i 's/64, 64/256, 256/' grains.scene
xsections 8e5 7.2e5 >x.xsect
# 20,000 in a voxel: what is left of their chance adds 2 % to the variance of the differences of blocks
particles --psd one.psd --count 1e7 --box 2m,2m,2m |
	medium-bake --xsect x.xsect --phase grains.phase --box 2m,2m,2m --voxels 8 -o particles.medium
bake() { medium-bake --xsect x.xsect --phase grains.phase --psd one.psd --concentration 1.25e6/m3 --box 2m,2m,2m "$@"; }
bake -o continuous.medium
bake --voxels 8 -o constant.medium
seed=1
for m in particles continuous constant; do
	sed "s/grains.medium/$m.medium/" grains.scene >$m.scene
	[ $m = continuous ] && t=continuous || t=grid
	twice $m $m.scene $seed --samples 8 --transport "$t"
	blocks $m G >$m.blocks
	rm $m.medium
	seed=$((seed + 2))
done
# 1,024 blocks and the whole: the rms of z is 1 within 0.1 but for 1 in 10^5, no |z| above 6 (a variance of 128 pixels: Student's t) but
# for 2 in 10^5.
for pair in 'particles continuous' 'constant continuous' 'particles constant'; do
	against "$pair" "${pair% *}.blocks" "${pair#* }.blocks" | zs 6 0.9 1.1 >told
	ok $? "$pair: $(cat told)"
done
done_testing
