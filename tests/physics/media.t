#!/bin/sh
# Several media in a scene, which overlap: collisions in each know nothing of the others.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"
# shellcheck source=tests/support/render.sh
. "$top/tests/support/render.sh"

one_size
hg 0.5 0.45 0.55 0.65 >5.phase
hg 0.8 0.45 0.55 0.65 >8.phase
hg 0.5 >5g.phase
hg 0.8 >8g.phase
# coloured NAME EXTINCTION ALBEDO PHASE [OPTION..]: extinctions at three wavelengths, 'a b c', per m
coloured() {
	name=$1 all=$2 albedo=$3 phase=$4
	shift 4
	echo "$all" | awk -v a="$albedo" '{
		print "# wavelength:f64:um\tradius:f64:um\tc_ext:f64:um^2\tc_sca:f64:um^2"
		for (w = 1; w <= 3; w++) printf "%g\t1000\t%.10g\t%.10g\n", 0.35 + 0.1 * w, $w * 1e6, $w * 1e6 * a }' | txttab >coloured.xsect
	medium-bake --xsect coloured.xsect --phase "$phase" --psd one.psd --concentration 1e6/m3 --box 2m,2m,2m "$@" -o "$name.medium"
}
# with NAME PIXELS LIGHTS MEDIUM..: NAME.scene; a medium is its name, and what else is said of it
with() {
	out=$1.scene lights=$3
	echo "camera = { position = [3.2, 2.4, 4.2]; target = [0.0, 0.0, 0.0]; fov = 18.0; resolution = [$2, $2]; };" >"$out"
	shift 3
	printf 'lights = ( %s );\nmedia = (' "$lights" >>"$out"
	between=
	for m; do
		printf '%s { file = "%s.medium"; %s}' "$between" "${m%% *}" "$(echo "$m " | cut -d' ' -f2-)" >>"$out"
		between=,
	done
	echo ' );' >>"$out"
}
sky='{ type = "environment"; radiance = 1.0; }'
day='{ type = "environment"; radiance = 0.2; }, { type = "sun"; direction = [-0.6, -1.0, -0.3]; irradiance = 3.0; angle = 20.0; }'

# ---- media that only absorb: extinctions add up, in closed form. Along x through the middle the first is 2 m thick, the second, which
# is moved by 1 m, too: of 3 m, 1 m in both. A camera far away with a narrow view sees the middle alone.
coloured black1 '0.2 0.3 0.4' 0 5.phase
coloured black2 '0.5 0.3 0.1' 0 5.phase --voxels 4
for t in continuous grid; do
	with black 16 "$sky" "black1" "black2 position = [1.0, 0.0, 0.0]; transport = \"$t\"; "
	sed -i 's/position = \[3.2, 2.4, 4.2\]; target = \[0.0, 0.0, 0.0\]; fov = 18.0/position = [50.0, 0.0, 0.0]; target = [0.0, 0.0, 0.0]; fov = 0.01/' black.scene
	vrender black.scene --samples 1024 --seed 1 -o black1.exr
	vrender black.scene --samples 1024 --seed 2 -o black2.exr
	# by wavelength e^-1.4, e^-1.2, e^-1; blue is the shortest
	for c in 'B 0.246597' 'G 0.301194' 'R 0.367879'; do
		for i in 1 2; do channels mean black$i.exr "${c% *}"; done | awk -v want="${c#* }" '{ all += $1 } END { print all / 2, want }' >got
		# of 5e5 samples the standard error is at most 7e-4; 4 of them
		awk '{ d = $1 - $2; exit !(d < 2.8e-3 && d > -2.8e-3) }' got
		ok $? "absorbing, $t, ${c% *}: $(cat got)"
	done
done

# ---- furnace: albedo 1, radiance 1 all around, three media in which everything may happen
cube white.medium 1e6 1 5g.phase
awk 'BEGIN { for (i = 0; i < 512; i++) printf "%s%g", i % 8 ? "," : i ? "\n" : "", i % 5 / 2 }' >field.csv
perl -e 'my @v = map { chomp; split /,/ } <STDIN>;
	my $h = "{\x27descr\x27: \x27<f4\x27, \x27fortran_order\x27: False, \x27shape\x27: (8, 8, 8), }"; $h .= " " x ((64 - (10 + length($h) + 1) % 64) % 64) . "\n";
	print "\x93NUMPY\x01\x00", pack("v", length $h), $h, pack("f<*", @v)' <field.csv >field.npy
dispersed 2e6 1 0.55 >field.xsect
medium-bake --xsect field.xsect --phase 8g.phase --psd one.psd --concentration 1e6/m3 --box 2m,2m,2m --density field.npy -o field.medium
dispersed 3e9 1 0.55 >grain.xsect
grains grains.medium 2000 grain.xsect 8g.phase
with furnace 48 "$sky" 'white' 'field position = [0.5, 0.0, 0.0]; ' 'grains position = [0.0, 0.5, 0.3]; '
vrender furnace.scene --samples 16 -o furnace.exr
low=$(channels min furnace.exr G) high=$(channels max furnace.exr G)
near "$low" 1 1e-5 && near "$high" 1 1e-5
ok $? "furnace of three media: pixels from $low to $high"

# ---- the same bytes from every way to run them
every_way three furnace.scene 3
MOTES_CL_BUFFER=256KiB vrender furnace.scene --samples 3 --backend opencl -o cl.exr 2>err
cmp -s three.exr cl.exr
ok $? "as by OpenCL from tables in parts $(cat err)"
sed 's/\[48, 48\]/[4, 3]/; s/fov = 18.0/fov = 5.0/' furnace.scene >tiny.scene
simulated 'three media' tiny.scene

# ---- two media of opposite colours against one of both, at all wavelengths, whichever comes first; 64 blocks and the whole
coloured reddish '2 1 0.2' 0.9 5.phase
coloured bluish '0.1 1 1.5' 0.9 5.phase --voxels 4
coloured both '2.1 2 1.7' 0.9 5.phase
with both 64 "$day" both
with two 64 "$day" 'reddish' 'bluish'
with turned 64 "$day" 'bluish transport = "grid"; ' 'reddish'
seed=1
for name in both two turned; do
	twice "$name" "$name.scene" $seed --samples 64
	seed=$((seed + 2))
done
same_picture both two
same_picture both turned

# ---- fog and grains: what is scattered once is the sum of what each scatters, the other only taking light away
xsections 1e6 0.9e6 >fog.xsect
xsections 1e6 0 >dark.xsect
xsections 6e8 3e8 >grains.xsect
xsections 6e8 0 >ash.xsect
for m in fog dark; do
	medium-bake --xsect $m.xsect --phase 5g.phase --psd one.psd --concentration 1e6/m3 --box 2m,2m,2m -o $m.medium
done
for m in grains ash; do grains $m.medium 1e4 $m.xsect 8g.phase; done
with all 64 "$day" 'fog' 'grains position = [0.3, 0.2, -0.4]; '
with fogs 64 "$day" 'fog' 'ash position = [0.3, 0.2, -0.4]; '
with grainy 64 "$day" 'grains position = [0.3, 0.2, -0.4]; ' 'dark'
for t in explicit fat-ray; do
	sed "s/ position = \[0.3, 0.2, -0.4\];/& transport = \"$t\";/" -i all.scene fogs.scene grainy.scene
	for name in all fogs grainy; do
		twice "$name" "$name.scene" $seed --samples 64
		seed=$((seed + 2))
		blocks "$name" single.G >"$name.blocks"
	done
	against "$t" all.blocks fogs.blocks grainy.blocks | zs 5 4 >told
	ok $? "fog and grains, $t: scattered once, $(cat told)"
	sed "s/ transport = \"$t\";//" -i all.scene fogs.scene grainy.scene
done

# ---- what is wrong is said
message() {
	wanted=$1
	shift
	"$@" >out 2>err
	[ $? -eq 2 ] && [ "$(wc -l <err)" -eq 1 ] && grep -q "$wanted" err
	ok $? "refused: $(cat err)"
}
with wrong 16 "$sky" both fog
message 'fog.medium: has 1 wavelengths, and .*both.medium 3' vrender wrong.scene -o wrong.exr
for bad in 'media = ( );' 'media = { file = "fog.medium"; };' 'media = ( { file = "fog.medium"; transport = "slow"; } );' \
	'media = ( { file = "fog.medium"; colour = 3; } );' 'media = ( { position = [0.0, 0.0, 0.0]; } );' \
	'medium = { file = "fog.medium"; }; media = ( { file = "fog.medium"; } );'; do
	{ sed '/^media/d' wrong.scene; echo "$bad"; } >bad.scene
	message "line 3: \|both" vrender bad.scene -o wrong.exr
done
done_testing
