#!/bin/sh
# Three classes of particles with phase functions of their own: what the mixture scatters once is the sum of what each class does, the
# others only taking light away.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"
# shellcheck source=tests/support/media.sh
. "$top/tests/support/media.sh"
sizes 3 >three.psd
{
	printf '# wavelength:f64:um\tradius:f64:um\ttheta:f64:deg\tp:f64:sr^-1\n'
	hg_rows 0 1000
	hg_rows 0.5 2000
	hg_rows 0.875 3000
} | txttab -o three.phase
# optical depth 2 across the cube of side 2 m, in parts of 1, 2 and 3, by 3e4 particles; albedos 0.9, 0.5 and 1
particles --psd three.psd --count 3e4 --box 2m,2m,2m -o three.tab
c1=1.333333333e8 c2=2.666666667e8 c3=4e8 s1=1.2e8 s2=1.333333333e8 s3=4e8
scenes='all one two three'
for name in $scenes; do
	case $name in
	all) xsections $c1 $s1 $c2 $s2 $c3 $s3 ;;
	one) xsections $c1 $s1 $c2 0 $c3 0 ;;
	two) xsections $c1 0 $c2 $s2 $c3 0 ;;
	three) xsections $c1 0 $c2 0 $c3 $s3 ;;
	esac >"$name.xsect"
	medium-bake --xsect "$name.xsect" --phase three.phase --box 2m,2m,2m -o "$name.medium" three.tab
	cat >"$name.scene" <<-EOT
	camera = { position = [0.0, 0.0, 10.0]; target = [0.0, 0.0, 0.0]; fov = 12.0; resolution = [128, 128]; };
	medium = { file = "$name.medium"; };
	lights = ( { type = "environment"; radiance = 0.2; }, { type = "sun"; direction = [-0.6, -1.0, 0.8]; irradiance = 3.0; },
		{ type = "sun"; direction = [1.0, 0.2, -1.0]; irradiance = 2.0; angle = 60.0; } );
	EOT
done
# The same classes without a mixture: for continuous, a medium of one class that has the mixture's extinction and scatters as much as
# that class does of it, by the numbers of particles that there are.
sizes 1 >one.psd
tabtxt --columns class three.tab | awk -v c="$c1 $c2 $c3" -v s="$s1 $s2 $s3" 'NR > 1 { n[$1 + 1]++ } END {
	split(c, ext); split(s, sca)
	for (k = 1; k <= 3; k++) all += n[k] * ext[k] / 8e6
	for (k = 1; k <= 3; k++) printf "%.9g %.9g\n", all, n[k] * sca[k] / 8e6 }' >alone
for k in 'one 0' 'two 0.5' 'three 0.875'; do
	name=${k% *}
	read -r c s
	hg "${k#* }" >alone.phase
	xsections "$c" "$s" >alone.xsect
	medium-bake --xsect alone.xsect --phase alone.phase --psd one.psd --concentration 1e6/m3 --box 2m,2m,2m -o "$name-alone.medium"
	sed "s/$name.medium/$name-alone.medium/" "$name.scene" >"$name-alone.scene"
done <alone

# 256 blocks and the whole: the rms of z beyond 4.3 standard deviations of it is chance for 2 in 10^5, |z| above 6 for 1 in 10^5;
# and none of the classes is a bystander: each gives at least 1/20 of the light.
seed=1
for t in continuous grid explicit; do
	for name in $scenes; do
		twice "$name" "$name.scene" $seed --samples 16 --transport $t
		blocks "$name" single.G >"$name.blocks"
		cp "$name.blocks" "$name-$t.blocks"
		seed=$((seed + 2))
	done
	against "$t" all.blocks one.blocks two.blocks three.blocks >lines
	zs 6 4.3 <lines >told
	ok $? "$t: single scattering of the mixture, $(cat told), the whole $(awk '$1 == "whole" { print $3, "for", $2, "+-", $4 }' lines)"
	paste one.blocks two.blocks three.blocks | awk '{ a += $1; b += $3; c += $5 } END { s = (a + b + c) / 20; exit !(a > s && b > s && c > s) }'
	ok $? "$t: all three classes scatter"
done
for k in one two three; do
	twice $k-alone $k-alone.scene $seed --samples 16
	blocks $k-alone single.G >$k-alone.blocks
	seed=$((seed + 2))
	against "class $k" $k-continuous.blocks $k-alone.blocks | zs 6 4.3 >told
	ok $? "continuous: a class of the mixture and it alone, $(cat told)"
done
# The others are the same but for the chance of 3e4 particles, 0.6 % of the mean over 12 other clouds, and what discs and voxels of finite
# size do to the mean itself, about as much: 3 % is 4 times the one beside the other.
for t in grid explicit; do
	paste all-continuous.blocks all-$t.blocks | awk '{ a += $1; b += $3 } END { print b / a; exit !(b < 1.03 * a && b > 0.97 * a) }' >told
	ok $? "$t: once scattered light in units of continuous $(cat told)"
done
done_testing
