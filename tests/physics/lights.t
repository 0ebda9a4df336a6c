#!/bin/sh
# Lights: furnaces that draw them, what is seen of them directly, and what they do to a ground, against closed forms.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"
# shellcheck source=tests/support/render.sh
. "$top/tests/support/render.sh"

# box HALF RADIANCE: six quads that face inwards.
box() {
	awk -v h="$1" -v r="$2" 'BEGIN {
		for (a = 0; a < 3; a++)
			for (s = -1; s <= 1; s += 2) {
				b = s < 0 ? (a + 1) % 3 : (a + 2) % 3
				for (k = 0; k < 3; k++) { c[k] = -h; e[k] = k == b ? 2 * h : 0; f[k] = k != a && k != b ? 2 * h : 0 }
				c[a] = s * h
				printf "%s{ type = \"quad\"; corner = [%.1f, %.1f, %.1f]; edge1 = [%.1f, %.1f, %.1f]; edge2 = [%.1f, %.1f, %.1f]; radiance = %s; }",
					(n++ ? ", " : ""), c[0], c[1], c[2], e[0], e[1], e[2], f[0], f[1], f[2], r
			}
	}'
}
# rgb WHAT FILE: of red, green and blue, to six decimals
# shellcheck disable=SC2046,SC2183
rgb() { printf '%.6f %.6f %.6f' $(channels "$1" "$2" R G B); }
# flat FILE COLOUR: every pixel is of that colour
flat() { is "$2 $2" "$(rgb min "$1") $(rgb max "$1")" "$3"; }
# view MEDIUM FROM TO FOV MORE: an 8 x 8 picture of a scene whose medium is far from it
view() {
	echo "camera = { position = [$2]; target = [$3]; fov = $4; resolution = [8, 8]; }; medium = { file = \"$1\"; position = [0.0, 0.0, 1e4]; }; $5" >view.scene
	vrender view.scene --samples 4 -o view.exr
}
# pair SCENE SAMPLES TRANSPORT: two seeds
pair() { for s in 1 2; do vrender "$1" --samples "$2" --transport "$3" --seed $s -o pair$s.exr; done; }

# ---- furnaces: radiance 1 all around, drawn and met

hg 0 0.55 >iso.phase
hg 0.8 0.55 >hg.phase
psd mono --radius 10um | goa-phase --particle water --wavelength 550nm --average --threads 2 -o goa.phase
dispersed 1000000000 1 0.55 >big.xsect
oiiotool --pattern constant:color=1,1,1 8x4 3 -d float -o ones.exr
for phase in hg goa; do
	cube $phase.medium 4000000 1 $phase.phase
	grains $phase-grains.medium 3e4 big.xsect $phase.phase
	for t in explicit fat-ray grid continuous; do
		[ $t != continuous ] && medium=$phase-grains.medium || medium=$phase.medium
		scene map.scene "$medium" 32 'lights = ( { type = "environment"; file = "ones.exr"; } );'
		pair map.scene 130 $t
		agree "furnace of a map, $phase, $t" 1 0 1e-3 pair1.exr pair2.exr
		scene box.scene "$medium" 32 "lights = ( $(box 6 1.0) );"
		pair box.scene 130 $t
		agree "furnace of a box of quads, $phase, $t" 1 0 1e-3 pair1.exr pair2.exr
		[ $phase = goa ] || continue        # physics/render.t has hg, more exactly
		scene suns.scene "$medium" 32 'lights = ( { type = "sun"; direction = [0.0, -1.0, 0.2]; irradiance = 3.14159265358979; angle = 180.0; },
			{ type = "sun"; direction = [0.0, 1.0, -0.2]; irradiance = 3.14159265358979; angle = 180.0; } );'
		pair suns.scene 130 $t
		agree "furnace of two hemispherical suns, $phase, $t" 1 0 1e-3 pair1.exr pair2.exr
	done
done
for t in explicit fat-ray grid continuous; do
	[ $t != continuous ] && medium=hg-grains.medium || medium=hg.medium
	# the walls touch the medium: points as near to a light as they like, and light that grazes
	echo "camera = { position = [0.9, 0.8, 0.95]; target = [0.0, 0.0, 0.0]; fov = 60.0; resolution = [32, 32]; };
		medium = { file = \"$medium\"; }; lights = ( $(box 1 1.0) );" >tight.scene
	if [ $t = fat-ray ]; then
		vrender tight.scene --samples 130 --transport $t --seed 1 -o pair1.exr
		imgcmp --max 0 explicit.exr pair1.exr >diff.txt
		ok $? "furnace of a box as large as the medium: seen from within it, fat rays are explicit"
	else
		pair tight.scene 130 $t
		agree "furnace of a box as large as the medium, $t" 1 0 1e-3 pair1.exr pair2.exr
		cp pair1.exr $t.exr
	fi
	scene both.scene "$medium" 32 "lights = ( { type = \"environment\"; file = \"ones.exr\"; radiance = 0.5; }, { type = \"environment\"; radiance = 0.3; },
		{ type = \"sun\"; direction = [0.0, -1.0, 0.2]; irradiance = 0.62831853; angle = 180.0; },
		{ type = \"sun\"; direction = [0.0, 1.0, -0.2]; irradiance = 0.62831853; angle = 180.0; } ); ground = { height = -1.1; albedo = 1.0; };"
	pair both.scene 130 $t
	agree "furnace of a map, an environment and suns on white ground, $t" 1 0 1e-3 pair1.exr pair2.exr
done

# ---- a map that is not even: four octants, drawn as a map and as three distant quads each

oiiotool --pattern constant:color=0,0,0 4x2 3 -d float --fill:color=4,1,0 1x1+0+0 --fill:color=0,2,1 1x1+2+0 --fill:color=1,0,3 1x1+3+0 \
	--fill:color=2,2,6 1x1+1+1 -o octants.exr
octant() { # octant SIGNS COLOUR: three faces of a large box
	echo "$1" | awk -v rgb="$2" '{
		h = 100000
		for (a = 0; a < 3; a++) {
			b = (a + 1) % 3; c = (a + 2) % 3
			for (k = 0; k < 3; k++) p[k] = e[k] = f[k] = 0
			p[a] = $(a + 1) * h; e[b] = $(b + 1) * h; f[c] = $(c + 1) * h
			# e x f points along a by the sign of the two edges; it must point inwards
			flip = $(b + 1) * $(c + 1) * $(a + 1) > 0
			for (k = 0; k < 3 && flip; k++) { t = e[k]; e[k] = f[k]; f[k] = t }
			printf "%s{ type = \"quad\"; corner = [%.1f, %.1f, %.1f]; edge1 = [%.1f, %.1f, %.1f]; edge2 = [%.1f, %.1f, %.1f]; radiance = [%s]; }",
				(a ? ", " : ""), p[0], p[1], p[2], e[0], e[1], e[2], f[0], f[1], f[2], rgb
		}
	}'
}
# columns of a map from the left: -x +z, -x -z, +x -z, +x +z
quads="$(octant '-1 1 1' '4.0, 1.0, 0.0'), $(octant '1 1 -1' '0.0, 2.0, 1.0'), $(octant '1 1 1' '1.0, 0.0, 3.0'), $(octant '-1 -1 -1' '2.0, 2.0, 6.0')"
for t in explicit fat-ray grid continuous; do
	[ $t != continuous ] && medium=hg-grains.medium || medium=hg.medium
	scene octants.scene "$medium" 48 'lights = ( { type = "environment"; file = "octants.exr"; } );'
	pair octants.scene 100 $t
	for s in 1 2; do mv pair$s.exr map$s.exr; done
	scene quads.scene "$medium" 48 "lights = ( $quads );"
	pair quads.scene 100 $t
	for c in R G B; do
		# the means of two pairs within 4 standard errors of their difference, neither of which is above 4e-3
		{
			channels mean map1.exr $c + map2.exr $c - pair1.exr $c - pair2.exr $c
			channels error map1.exr $c - map2.exr $c
			channels error pair1.exr $c - pair2.exr $c
		} | awk '{ x[NR] = $1 / 2 } END {
			printf "%.6f, standard errors %.3g and %.3g", x[1], x[2], x[3]
			exit !(NR == 3 && x[1] ^ 2 <= 16 * (x[2] ^ 2 + x[3] ^ 2) && x[2] > 0 && x[2] <= 4e-3 && x[3] > 0 && x[3] <= 4e-3) }' >told
		ok $? "octants as a map less as quads, channel $c, $t: $(cat told)"
	done
done

# ---- seen directly: a light is its own colour, whatever the wavelengths

hg 0.7 0.45 0.55 0.65 >three.phase
dispersed 90000000 0.97 0.45 0.55 0.65 >three.xsect
grains three.medium 3000 three.xsect three.phase
hg 0.7 0.40 0.44 0.48 0.52 0.56 0.60 0.64 0.68 >eight.phase
dispersed 3000000 0.9 0.40 0.44 0.48 0.52 0.56 0.60 0.64 0.68 >eight.xsect
medium-bake --xsect eight.xsect --phase eight.phase --psd one.psd --concentration 1e6/m3 --sphere 1m -o eight.medium
quad='{ type = "quad"; corner = [-1.0, -1.0, -3.0]; edge1 = [2.0, 0.0, 0.0]; edge2 = [0.0, 2.0, 0.0]; radiance = [0.5, 0.25, 2.0]; }'
for m in hg three eight; do
	view $m.medium '0.0, 0.0, 0.0' '0.0, 0.0, -1.0' 30.0 "lights = ( $quad );"
	flat view.exr '0.500000 0.250000 2.000000' "a quad's own colour, medium $m"
done
view hg.medium '0.0, 0.0, -6.0' '0.0, 0.0, -1.0' 30.0 "lights = ( { type = \"environment\"; radiance = 1; }, $quad );"
flat view.exr '0.000000 0.000000 0.000000' 'its back is black, and opaque'
view hg.medium '0.0, 0.0, 0.0' '0.0, 0.0, -1.0' 67.3801350520 "lights = ( $quad );"
oiiotool view.exr --crop 4x4+2+2 -o inside.exr
flat inside.exr '0.500000 0.250000 2.000000' 'of a view twice as wide, the middle half is the quad'
is '0.125000 0.062500 0.500000' "$(rgb mean view.exr)" 'and the rest is black'

# ---- orientation of a map: top row +y, centre column -z, columns turn towards +x

oiiotool --pattern constant:color=0,0,0 360x180 3 -d float --fill:color=1,2,3 1x1+200+79 --fill:color=4,5,6 1x1+89+79 --fill:color=7,8,9 1x1+359+100 \
	--fill:color=10,11,12 360x1+0+0 --fill:color=13,14,15 360x1+0+179 -o spots.exr
look() { # look AZIMUTH_FROM_-Z_TOWARDS_+X ELEVATION UP COLOUR NAME
	to=$(awk -v a="$1" -v e="$2" 'BEGIN { d = atan2(0, -1) / 180; printf "%.9f, %.9f, %.9f", sin(a*d)*cos(e*d), sin(e*d), -cos(a*d)*cos(e*d) }')
	view hg.medium '0.0, 0.0, 0.0' "$to" 0.6 'lights = ( { type = "environment"; file = "spots.exr"; } );'
	flat view.exr "$3" "$4"
}
look 20.5 10.5 '1.000000 2.000000 3.000000' 'right of the centre is between -z and +x'
look -20.5 10.5 '0.000000 0.000000 0.000000' 'and not on the other side'
look 20.5 -10.5 '0.000000 0.000000 0.000000' 'nor below'
look -90.5 10.5 '4.000000 5.000000 6.000000' 'a quarter from the left is -x'
look 179.5 -10.5 '7.000000 8.000000 9.000000' 'the right edge is +z'
look 77 89.5 '10.000000 11.000000 12.000000' 'the top row is +y'
look 77 -89.5 '13.000000 14.000000 15.000000' 'the bottom row is -y'
oiiotool --pattern constant:color=0,1,0 2x1 3 -d float --fill:color=1,0,0 1x1+1+0 -o halves.exr
view hg.medium '0.0, 0.0, 0.0' '0.0, 0.0, -1.0' 60.0 'lights = ( { type = "environment"; file = "halves.exr"; radiance = [3.0, 2.0, 1.0]; } );'
oiiotool view.exr --crop 4x8+4+0 -o right.exr view.exr --crop 4x8+0+0 -o left.exr
flat right.exr '3.000000 0.000000 0.000000' "a picture's right is a map's right, scaled by a colour"
flat left.exr '0.000000 2.000000 0.000000' 'and its left the left'

# ---- a ground under them, against closed forms: no medium in between

ground='ground = { height = 0.0; albedo = 0.8; };'
# lit NAME WANT LIGHTS [HEIGHT]: radiance of the ground at the origin, from a camera at that height
lit() {
	echo "camera = { position = [3.0, ${4:-2.0}, 5.0]; target = [0.0, 0.0, 0.0]; fov = 0.0005; resolution = [16, 16]; };
		medium = { file = \"hg.medium\"; position = [0.0, 0.0, 1e3]; }; $ground lights = ( $3 );" >lit.scene
	pair lit.scene 1024 continuous
	agree "$1" "$2" "$(awk -v w="$2" 'BEGIN { print w * 1e-5 }')" "$(awk -v w="$2" 'BEGIN { print w * 2e-3 }')" pair1.exr pair2.exr
}
# parallel rectangle a x b at height h, centred: form factor of a point below
over() { awk -v a="$1" -v b="$2" -v h="$3" 'BEGIN {
	A = a / 2 / h; B = b / 2 / h; p = sqrt(1 + A * A); q = sqrt(1 + B * B)
	printf "%.8g", 0.8 * 2 / atan2(0, -1) * (A / p * atan2(B, p) + B / q * atan2(A, q)) }'; }
# wall of width w and height h standing at distance d
wall() { awk -v w="$1" -v h="$2" -v d="$3" 'BEGIN {
	X = h / (w / 2); Y = d / (w / 2); r = sqrt(X * X + Y * Y)
	printf "%.8g", 0.8 / atan2(0, -1) * (atan2(1, Y) - Y / r * atan2(1, r)) }'; }
lit 'ground under a quad of 2 m x 1 m at 1 m' "$(over 2 1 1)" \
	'{ type = "quad"; corner = [-1.0, 1.0, -0.5]; edge1 = [2.0, 0.0, 0.0]; edge2 = [0.0, 0.0, 1.0]; radiance = 1.0; }'
lit 'ground under a quad at 1 mm' "$(over 1 1 0.001)" \
	'{ type = "quad"; corner = [-0.5, 0.001, -0.5]; edge1 = [1.0, 0.0, 0.0]; edge2 = [0.0, 0.0, 1.0]; radiance = 1.0; }' 0.0005
lit 'ground at 1 m from a wall' "$(wall 3 2 1)" \
	'{ type = "quad"; corner = [-1.5, 0.0, -1.0]; edge1 = [3.0, 0.0, 0.0]; edge2 = [0.0, 2.0, 0.0]; radiance = 1.0; }'
lit 'ground at 1 cm from a wall' "$(wall 3 2 0.01)" \
	'{ type = "quad"; corner = [-1.5, 0.0, -0.01]; edge1 = [3.0, 0.0, 0.0]; edge2 = [0.0, 2.0, 0.0]; radiance = 1.0; }'
# a map with a bright spot: sum of L (sin^2 of the rows' ends) / 2 x azimuth
oiiotool --pattern constant:color=0.5,0.5,0.5 64x32 3 -d float --fill:color=1000,1000,1000 2x2+20+5 --fill:color=3,3,3 64x1+0+14 -o spot.exr
want=$(awk 'BEGIN { pi = atan2(0, -1)
	for (r = 0; r < 16; r++) { c = (sin((r + 1) * pi / 32)^2 - sin(r * pi / 32)^2) / 2 * 2 * pi / 64
		e += c * (r == 14 ? 3 * 64 : r == 5 || r == 6 ? 1000 * 2 + 0.5 * 62 : 0.5 * 64) }
	printf "%.8g", 0.8 * e / pi }')
lit 'ground under a map with a bright spot' "$want" '{ type = "environment"; file = "spot.exr"; }'

# a black quad 5 mm before a lamp 1 km away, and a lamp 5 mm under the ground: no light comes by
lamp='{ type = "quad"; corner = [-300.0, 1000.0, -300.0]; edge1 = [600.0, 0.0, 0.0]; edge2 = [0.0, 0.0, 600.0]; radiance = 1.0; }'
shade='{ type = "quad"; corner = [-400.0, 999.995, -400.0]; edge1 = [800.0, 0.0, 0.0]; edge2 = [0.0, 0.0, 800.0]; radiance = 0.0; }'
view hg.medium '0.0, 0.5, 9.0' '0.0, 0.0, 0.0' 0.1 "$ground lights = ( $lamp, $shade );"
flat view.exr '0.000000 0.000000 0.000000' 'a shade close before a distant lamp'
scene deep.scene hg.medium 8 'ground = { height = -1.5; albedo = 0.0; }; lights = ( { type = "quad"; corner = [-3.0, -1.505, -3.0];
	edge1 = [0.0, 0.0, 6.0]; edge2 = [6.0, 0.0, 0.0]; radiance = 1.0; } );'
vrender deep.scene --samples 16 -o view.exr
flat view.exr '0.000000 0.000000 0.000000' 'a lamp under the ground lights nothing'

# a quad stands in the sun: shadow and light are exact
shade='{ type = "quad"; corner = [-1.0, 1.0, -1.0]; edge1 = [2.0, 0.0, 0.0]; edge2 = [0.0, 0.0, 2.0]; radiance = 0.0; }'
sun='{ type = "sun"; direction = [0.0, -1.0, 0.0]; irradiance = 3.14159265358979; }'
view hg.medium '0.0, 0.5, 9.0' '0.0, 0.0, 0.0' 0.1 "$ground lights = ( $sun, $shade );"
flat view.exr '0.000000 0.000000 0.000000' 'the shadow of a quad is black'
view hg.medium '3.0, 0.5, 9.0' '3.0, 0.0, 0.0' 1.0 "$ground lights = ( $sun, $shade );"
flat view.exr '0.800000 0.800000 0.800000' 'and beside it is the light'
# a lid over the ground point: what a quad leaves of a map is what it covers, taken away
oiiotool --pattern constant:color=1,1,1 16x8 3 -d float -o even.exr
lit 'ground under an even map that a black quad covers' "$(awk -v f="$(over 2 1 1)" 'BEGIN { printf "%.8g", 0.8 - f }')" \
	'{ type = "environment"; file = "even.exr"; }, { type = "quad"; corner = [-1.0, 1.0, -0.5]; edge1 = [2.0, 0.0, 0.0]; edge2 = [0.0, 0.0, 1.0]; radiance = 0.0; }'

# ---- fifteen dim quads far away leave the noise as it is, and the light what it should be

near='{ type = "quad"; corner = [-1.0, 3.0, -1.0]; edge1 = [2.0, 0.0, 0.0]; edge2 = [0.0, 0.0, 2.0]; radiance = 9.0; }'
dim=$(awk 'BEGIN { for (i = 0; i < 15; i++)
	printf ", { type = \"quad\"; corner = [%.1f, 300.0, -100.0]; edge1 = [9.0, 0.0, 0.0]; edge2 = [0.0, 0.0, 9.0]; radiance = 0.1; }", 20 * i - 150 }')
for t in explicit continuous; do
	[ $t != continuous ] && medium=hg-grains.medium || medium=hg.medium
	for many in '' "$dim"; do
		scene dim.scene "$medium" 64 "lights = ( $near$many );"
		pair dim.scene 64 $t
		channels rms pair1.exr G - pair2.exr G
		channels mean pair1.exr G
	done >noise.txt
	awk '{ x[NR] = $1 } END { r = x[3] / x[1]; m = x[4] / x[2] - 1; print r; exit !(NR == 4 && r < 1.1 && m < 0.02 && m > -0.02) }' noise.txt >ratio.txt
	ok $? "fifteen dim quads far away raise the noise by $(cat ratio.txt), $t"
done

# ---- the same bytes, and no wrong access, with all lights

all="lights = ( { type = \"environment\"; radiance = [0.1, 0.2, 0.3]; }, { type = \"environment\"; file = \"spot.exr\"; radiance = 0.1; },
	{ type = \"sun\"; direction = [-0.6, -1.0, -0.3]; irradiance = 2.0; angle = 10.0; }, { type = \"sun\"; direction = [1, -1, 0]; irradiance = [2, 1, 1]; },
	{ type = \"quad\"; corner = [-2.0, 1.5, -1.0]; edge1 = [1.0, 0.3, 0.0]; edge2 = [0.0, 0.2, 2.0]; radiance = [9.0, 6.0, 3.0]; }, $shade );
	ground = { height = -1.2; albedo = 0.4; };"
scene all.scene three.medium 32 "$all"
dispersed 10000000000 0.97 0.45 0.55 0.65 >tiny.xsect
grains tiny.medium 300 tiny.xsect three.phase
scene tiny.scene tiny.medium 4 "$all"
same_bytes all.scene 8 tiny.scene

# ---- bad input in one line

wrong() { # wrong NAME PATTERN LIGHTS
	scene bad.scene hg.medium 8 "lights = ( $3 );"
	refused "$1" "$2" vrender bad.scene -o bad.exr
}
wrong 'an unknown key of a quad' "line 3: unknown key 'edge3'" '{ type = "quad"; corner = [0, 0, 0]; edge1 = [1, 0, 0]; edge2 = [0, 1, 0]; edge3 = [0, 0, 1]; radiance = 1; }'
wrong 'a quad without area' 'do not span a quad' '{ type = "quad"; corner = [0, 0, 0]; edge1 = [1, 0, 0]; edge2 = [-2, 0, 0]; radiance = 1; }'
wrong 'a quad without an edge' "needs a key 'edge2'" '{ type = "quad"; corner = [0, 0, 0]; edge1 = [1, 0, 0]; radiance = 1; }'
wrong 'negative radiance' 'radiance -1 is out of range' '{ type = "environment"; radiance = [0, -1, 0]; }'
wrong 'a colour of two numbers' 'must be 3 numbers' '{ type = "environment"; radiance = [1, 1]; }'
wrong 'a light of no known type' 'type must be' '{ type = "lamp"; }'
wrong 'a map that is not there' 'nowhere.exr: cannot' '{ type = "environment"; file = "nowhere.exr"; }'
wrong 'a map that is a number' 'file must be a string' '{ type = "environment"; file = 3; }'
wrong 'two maps' 'a second environment map' '{ type = "environment"; file = "ones.exr"; }, { type = "environment"; file = "ones.exr"; }'
wrong 'seventeen lights' 'more than 16' "$(box 1 1), $(box 2 1), $(box 3 1)"
echo 'no image' >text.exr
wrong 'a map that is no EXR' 'text.exr: ' '{ type = "environment"; file = "text.exr"; }'
oiiotool --pattern constant:color=1,1,1 8x4 3 -d float --compression none -o nan.exr
printf '\000\000\300\177' | dd of=nan.exr bs=1 seek=$(($(wc -c <nan.exr) - 4)) conv=notrunc 2>/dev/null
wrong 'a texel that is not a number' 'nan.exr: channel R is nan at column 7, row 3' '{ type = "environment"; file = "nan.exr"; }'
oiiotool --pattern constant:color=1,-2,1 8x4 3 -d float -o negative.exr
wrong 'a negative texel' 'negative.exr: channel G is -2 at column 0, row 0' '{ type = "environment"; file = "negative.exr"; }'
is '' "$(ls bad.exr* 2>/dev/null)" 'no image appears under its name'
mkdir folder
cp hg.medium folder
scene folder/a.scene hg.medium 8 'lights = ( { type = "environment"; file = "beside.exr"; } );'
cp ones.exr folder/beside.exr
vrender folder/a.scene --samples 1 -o beside.exr
ok $? "a map lies beside its scene"
done_testing
