#!/bin/sh
# Where a cloud lies and how far away the camera is does not matter.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"
# shellcheck source=tests/support/render.sh
. "$top/tests/support/render.sh"

# ---- a cloud of 4,000 grains about the origin, in a corner of it, and in coordinates of a map: no box is given

hg 0 0.55 >iso.phase
one_size
xsections "4e8 3e8" >grains.xsect
particles --psd one.psd --count 4000 --box 1m,1m,1m | tabtxt | sed '1s/:f32:m/:f64:m/g' >cloud.txt
# placed NAME X Y Z: the cloud moved there, and a scene that looks at it
placed() {
	awk -F'\t' -v OFS='\t' -v x="$2" -v y="$3" -v z="$4" '/^#/ { print; next }
		{ print sprintf("%.17g", $1 + x), sprintf("%.17g", $2 + y), sprintf("%.17g", $3 + z), $4, $5 }' cloud.txt | txttab |
		medium-bake --xsect grains.xsect --phase iso.phase -o "$1.medium"
	awk -v name="$1" -v x="$2" -v y="$3" -v z="$4" 'BEGIN {
		printf "camera = { position = [%.1f, %.1f, %.1f]; target = [%.1f, %.1f, %.1f]; fov = 5.0; resolution = [32, 32]; };\n", x, y, z + 10, x, y, z
		printf "medium = { file = \"%s.medium\"; };\n", name
		printf "lights = ( { type = \"environment\"; radiance = 0.5; }, { type = \"sun\"; direction = [-1, -1, -1]; irradiance = 1; },"
		printf " { type = \"quad\"; corner = [%.1f, %.1f, %.1f]; edge1 = [4.0, 0.0, 0.0]; edge2 = [0.0, 0.0, 4.0]; radiance = 2.0; } );\n", x - 2, y - 2, z - 2
		printf "ground = { height = %.1f; albedo = 0.3; };\n", y - 3 }' >"$1.scene"
}
placed origin 0 0 0
placed corner 0.5 0.5 0.5
placed map 5e5 4.5e6 100
for t in explicit fat-ray grid continuous; do
	for p in origin corner map; do
		vrender $p.scene --transport $t --samples 32 -o $p.exr
		channels mean $p.exr A G single.G depth.Z >$p.txt
	done
	# the same random numbers: what differs are rays that rounding puts on the other side of a disc's edge
	paste origin.txt corner.txt map.txt | awk '{ for (i = 1; i <= 4; i++) for (k = 4; k <= 8; k += 4) {
		d = $(i + k) / $i - 1; d = d < 0 ? -d : d; if (d > most) most = d } printf "%.3g\n", most; exit !(NF == 12 && $1 > 0.5 && most < 1e-3) }' >most.txt
	ok $? "$t: a cloud looks the same wherever it is, within $(cat most.txt): $(cat map.txt)"
done
tabtxt=$(grep -a -m 1 '^centre' map.medium | cut -f 2-4 | awk '{ printf "%.2f %.2f %.2f", $1, $2, $3 }')
near "${tabtxt%% *}" 500000 0.01
ok $? "a medium keeps the user's coordinates: $tabtxt"

# ---- a cube of side 2 m and optical depth 2 from ever further away, its middle 1.8 m

cube grey.medium 1e6 0.9 iso.phase
xsections "2e8 1.8e8" >small.xsect
particles --psd one.psd --count 40000 --box 2m,2m,2m | medium-bake --xsect small.xsect --phase iso.phase --box 2m,2m,2m -o grey-grains.medium
for t in continuous grid explicit; do
	[ $t = continuous ] && medium=grey.medium || medium=grey-grains.medium
	for d in 1e3 1e4 1e5 1e6 1e7 1e8; do
		awk -v d="$d" -v m="$medium" 'BEGIN {
			printf "camera = { position = [%.9g.0, %.9g.0, %.9g.0]; target = [0.0, 0.0, 0.0]; fov = %.12g; resolution = [32, 32]; };\n", 0, 0, d, 360 / atan2(0, -1) * atan2(0.9, d)
			printf "medium = { file = \"%s\"; }; lights = ( { type = \"sun\"; direction = [-1, 0, 0]; irradiance = 3; } );\n", m }' |
			sed 's/e+\([0-9]*\)\.0/e+\1/g' >far.scene
		vrender far.scene --transport $t --samples 64 -o far.exr
		echo "$d $(channels mean far.exr A G depth.Z)"
	done >far.txt
	# 64^2 x 16 coins of A, standard error 1.5e-3; radiance spreads less. A float of the depth is 6e-8 of it at best
	awk 'NR == 1 { a = $2; g = $3; below = $4 - 1000 } { da = $2 - a; dg = $3 / g - 1; dz = ($4 - $1 - below) / (1e-7 * $1 + 0.02)
		bad += da * da > 0.006^2 || dg * dg > 0.02^2 || dz * dz > 1 } END { exit !(NR == 6 && a > 0.8 && g > 0.01 && !bad) }' far.txt
	ok $? "$t: alpha, radiance and depth from 1e3 to 1e8 m: $(paste -s -d, far.txt)"
done
done_testing
