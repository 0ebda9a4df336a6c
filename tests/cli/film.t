#!/bin/sh
# The film: its layers hold what they say, and parts of an image add up to its bytes.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"
# shellcheck source=tests/support/render.sh
. "$top/tests/support/render.sh"

# far NAME MEDIUM MORE: the cube's face from 1000 m, rays all but parallel; only its middle 1.745 m are seen
far() {
	echo "camera = { position = [0.0, 0.0, 1000.0]; target = [0.0, 0.0, 0.0]; fov = 0.1; resolution = [64, 64]; };
		medium = { file = \"$2\"; }; $3" >"$1"
}

hg 0 >iso.phase
for m in 'black 0' 'white 1'; do
	cube "${m% *}.medium" 1e6 "${m#* }" iso.phase
	dispersed 4e8 "${m#* }" 0.55 >grains.xsect
	grains "${m% *}-grains.medium" 2e4 grains.xsect iso.phase
done

# ---- light by orders: what was not scattered is the black medium's image, path by path

lights='lights = ( { type = "environment"; radiance = 0.2; }, { type = "sun"; direction = [-0.6, -1.0, -0.3]; irradiance = 2.0; angle = 10.0; } );'
for t in continuous explicit fat-ray grid; do
	[ $t = continuous ] && grainy= || grainy=-grains
	for ground in '' ' ground = { height = -1.2; albedo = 0.4; };'; do
		for m in black white; do
			scene $m.scene "$m$grainy.medium" 32 "$lights$ground"
			vrender $m.scene --samples 16 --transport $t -o $m.exr
		done
		for what in min max; do
			channels $what black.exr R G B + white.exr single.R single.G single.B + white.exr multiple.R multiple.G multiple.B - white.exr R G B
		done | awk '{ for (i = 1; i <= NF; i++) bad += $i > 2e-6 || $i < -2e-6 } END { exit !(NR * NF == 6 && !bad) }'
		ok $? "unscattered, single and multiple make up the image: $t${ground:+, ground}"
		[ "$(channels max black.exr single.R multiple.R)" = '0 0' ] && near "$(channels mean white.exr multiple.G)" 0.1 0.09
		ok $? "a black medium scatters nothing, a white one does: $t${ground:+, ground}"
	done
done
# a parallel sun from +x of irradiance 4 pi on extinction 1/m: (1 - e^-2) times the mean of e^-(1 - x) over what is seen
far sun.scene white.medium 'lights = ( { type = "sun"; direction = [-1, 0, 0]; irradiance = 12.566370614; } );'
vrender sun.scene --samples 64 -o sun.exr
want=$(awk 'BEGIN { w = 0.872665; print (1 - exp(-2)) * exp(-1) * (exp(w) - exp(-w)) / 2 / w }')
# 64^2 x 64 samples of spread below 0.3: standard error below 6e-4
got=$(channels mean sun.exr single.G)
near "$got" "$want" 0.0024
ok $? "single scattering: $got, wanted $want"

# ---- alpha and depth

for t in continuous explicit fat-ray grid; do
	[ $t = continuous ] && grainy= || grainy=-grains
	far beer.scene "black$grainy.medium" ''
	vrender beer.scene --samples 64 --transport $t -o beer.exr
	near "$(channels min beer.exr R + beer.exr A)" 1 2e-6 && near "$(channels max beer.exr R + beer.exr A)" 1 2e-6
	ok $? "$t: alpha is what a black medium takes away, in every pixel"
done
# 64^2 x 64 coins: standard error 6.7e-4
far beer.scene black.medium ''
vrender beer.scene --samples 64 -o beer.exr
got=$(channels mean beer.exr A)
near "$got" 0.8646647 0.003
ok $? "alpha by Beer and Lambert: $got"
# from the face at 999 m: mean 1/s - L e^-sL / (1 - e^-sL), spread 0.54 m, standard error 1.1e-3 m
got=$(channels mean beer.exr depth.Z)
near "$got" 999.68696 0.005
ok $? "mean depth of the first scattering: $got"
scene aside.scene black.medium 8 ''
sed -i 's/target = .0.0, 0.0, 0.0./target = [9.0, 9.0, 9.0]/' aside.scene
vrender aside.scene --samples 4 -o aside.exr
is '0 0' "$(channels max aside.exr A depth.Z)" 'beside the medium alpha and depth are 0'

# ---- alpha of a coloured medium: by channels, and by wavelengths, what a black one takes away from white light, in every pixel

hg 0 0.45 0.55 0.65 >iso3.phase
cube tint.medium 5e5 0 iso3.phase 0.45 0.55 0.65
many='0.40 0.42 0.44 0.46 0.48 0.50 0.52 0.54 0.56 0.58 0.60 0.62'
# shellcheck disable=SC2086
{
	hg 0 $many >iso12.phase
	cube many-tint.medium 5e5 0 iso12.phase $many
	dispersed 4e8 0 0.45 0.55 0.65 >tint.xsect
}
grains tint-grains.medium 2e4 tint.xsect iso3.phase
for t in 'continuous tint' 'continuous many-tint' 'grid tint-grains' 'explicit tint-grains' 'fat-ray tint-grains'; do
	far tint.scene "${t#* }.medium" ''
	vrender tint.scene --samples 64 --spectral --transport "${t% *}" -o tint.exr
	worst=$(spectral_alpha tint.exr | awk '$1 == "worst" { print $2 }')
	# of twelve wavelengths two groups take turns: white is whole to the rounding of their weights
	near "$worst" 0 4e-6
	ok $? "$t: alpha of each channel and wavelength is what is taken away there: within $worst"
done
# 64^2 x 64 paths: standard error below 1e-3
far tint.scene tint.medium ''
vrender tint.scene --samples 64 --spectral -o tint.exr
spectral_alpha tint.exr >tint.txt
for c in 'AR 0.6' 'AG 0.55' 'AB 0.5' 'A.650,000000nm 0.6' 'A.550,000000nm 0.55' 'A.450,000000nm 0.5'; do
	want=$(awk -v s="${c#* }" 'BEGIN { print 1 - exp(-2 * s) }')
	got=$(awk -v c="${c% *}" '$1 == c { print $2 }' tint.txt)
	near "$got" "$want" 0.004
	ok $? "alpha by Beer and Lambert, ${c% *}: $got, wanted $want"
done
# another background: a scene's own is that laid behind it
dispersed 5e5 0.8 0.45 0.55 0.65 >cube.xsect
medium-bake --xsect cube.xsect --phase iso3.phase --psd one.psd --concentration 1e6/m3 --box 2m,2m,2m -o dyed.medium
sun='{ type = "sun"; direction = [-0.6, -1.0, -0.3]; irradiance = 2.0; }'
back='{ type = "quad"; corner = [-9.0, -9.0, -3.0]; edge1 = [18.0, 0.0, 0.0]; edge2 = [0.0, 18.0, 0.0]; radiance = [0.2, 0.5, 1.0]; }'
far none.scene dyed.medium "lights = ( $sun );"
far laid.scene dyed.medium "lights = ( $sun, $back );"
vrender none.scene --samples 256 -o none.exr
vrender laid.scene --samples 256 -o laid.exr
for c in 'R 0.2' 'G 0.5' 'B 1.0'; do
	# what the medium did not scatter, all - single - multiple, is (1 - A) background
	got=$(channels mean laid.exr "${c% *}" - laid.exr "single.${c% *}" - laid.exr "multiple.${c% *}")
	want=$(awk -v a="$(channels mean none.exr "A${c% *}")" -v b="${c#* }" 'BEGIN { print (1 - a) * b }')
	near "$got" "$want" 0.002
	ok $? "a background laid behind, ${c% *}: $got, wanted $want"
done
is '' "$(oiiotool --info -v sun.exr | grep -o ' A[RGB],')" 'of one wavelength alpha has no colour'

# ---- the variance: none where all samples are equal; physics/variance.t says that it is right

scene furnace.scene white.medium 16 ''
vrender furnace.scene --samples 16 -o furnace.exr
near "$(channels max furnace.exr variance.Y)" 0 1e-9
ok $? 'the furnace has none'
vrender furnace.scene --samples 1 -o furnace1.exr
is 0 "$(channels max furnace1.exr variance.Y)" 'nor has a single sample'

# ---- parts of an image

hg 0.1 0.45 0.55 0.65 >three.phase
dispersed 4e8 0.97 0.45 0.55 0.65 >three.xsect
grains three.medium 2e4 three.xsect three.phase
full="lights = ( { type = \"environment\"; radiance = 0.3; }, { type = \"sun\"; direction = [-0.6, -1.0, -0.3]; irradiance = 2.0; angle = 10.0; },
	{ type = \"sun\"; direction = [1, -1, 0]; irradiance = 1; } ); ground = { height = -1.2; albedo = 0.4; };"
scene three.scene three.medium 24 "$full"
for t in explicit fat-ray grid continuous; do
	for o in '' --spectral; do
		vrender three.scene --transport $t $o --samples 9 -o whole.exr
		vrender three.scene --transport $t $o --sample-range 0:3 -o a.exr
		vrender three.scene --transport $t $o --sample-range 3:4 --backend opencl -o b.exr
		vrender three.scene --transport $t $o --sample-range 4:9 --threads 1 -o c.exr
		exr-merge --whole -o m.exr c.exr a.exr b.exr
		cmp whole.exr m.exr
		ok $? "$t $o: three parts, one of them by OpenCL, make the image's bytes"
		exr-merge -o ac.exr a.exr c.exr
		exr-merge --whole -o m.exr b.exr ac.exr
		cmp whole.exr m.exr
		ok $? "$t $o: in another grouping too"
		vrender three.scene --transport $t $o --samples 9 --sample-range 0:4 -o a.exr
		vrender three.scene --transport $t $o --sample-range 4:9 --samples 9 -o b.exr
		exr-merge -o - - a.exr <b.exr >m.exr
		cmp whole.exr m.exr
		ok $? "$t $o: two parts, of a whole known beforehand, through pipes"
		vrender three.scene --transport $t $o --samples 9 --backend opencl -o cl.exr
		cmp whole.exr cl.exr
		ok $? "$t $o: OpenCL gives the bytes of C"
	done
done
vrender three.scene --sample-range 0:3 --samples 9 -o a.exr
vrender three.scene --sample-range 3:4 --samples 9 -o b.exr
vrender three.scene --sample-range 4:9 --samples 9 -o c.exr
vrender three.scene --samples 9 -o whole.exr
vrender three.scene --sample-range 2:5 --samples 9 -o overlap.exr
exr-merge -o ab.exr a.exr b.exr
exr-merge -o m.exr c.exr ab.exr
cmp whole.exr m.exr
ok $? 'a whole known beforehand: its first parts stay a part'
for r in 0:3 3:5 5:9 0:9; do vrender three.scene --sample-range $r -o open$r.exr; done
exr-merge -o open.exr open0:3.exr open3:5.exr
exr-merge -o m.exr open.exr open5:9.exr
cmp open0:9.exr m.exr
ok $? 'samples from 0 on stay a part, to which more are added'
exr-merge --whole -o m.exr m.exr
cmp whole.exr m.exr
ok $? 'until they are said to be the whole'
refused 'a whole with a gap' 'whole: samples are missing' exr-merge --whole -o x.exr open0:3.exr open5:9.exr
refused 'a whole that is to have more' 'whole: samples are missing' exr-merge --whole -o x.exr ab.exr
exr-merge -o same.exr ab.exr
cmp ab.exr same.exr
ok $? 'a part alone stays what it is'
oiiotool --stats whole.exr ab.exr >stats.txt && ! grep -E 'NanCount.*[1-9]|InfCount.*[1-9]' stats.txt
ok $? 'an independent reader takes both, and finds nothing that is no number'
# all but the integers, which it turns to floats
oiiotool whole.exr -d float -o again.exr &&
	imgcmp --channels R,G,B,A,AR,AG,AB,single.R,single.G,single.B,multiple.R,multiple.G,multiple.B,depth.Z,variance.Y whole.exr again.exr >diff.txt
ok $? 'and reads the same numbers in every layer'
imgcmp --channels R,G,B,A,single.G ab.exr ab.exr >/dev/null && exr2png ab.exr -o ab.png
ok $? 'and so do our own, a part like a whole'
imgcmp --max 9e9 a.exr c.exr >out && ! grep sum out && ! imgcmp ab.exr overlap.exr >out && grep -q 'sum.R.lo: other integers' out
ok $? 'their sums are compared bit by bit, never as numbers'

refused 'samples twice' 'overlap.exr: its samples 2:5 of 9 are in part among' exr-merge -o x.exr a.exr overlap.exr
refused 'a part twice' 'a.exr: its samples' exr-merge -o x.exr a.exr b.exr a.exr
vrender three.scene --sample-range 3:4 --samples 9 --seed 2 -o seed.exr
refused 'another seed' 'seed.exr: is not of the same image' exr-merge -o x.exr a.exr seed.exr
vrender three.scene --sample-range 3:4 -o open.exr
refused 'another whole' 'open.exr: is not of the same image' exr-merge -o x.exr a.exr open.exr
refused 'an image without sums' 'whole.exr: has no sums to add' exr-merge -o x.exr a.exr whole.exr
refused 'a part beyond the whole' "'4:10' goes beyond --samples 9" vrender three.scene --samples 9 --sample-range 4:10 -o x.exr
refused 'no range' 'is not A:B' vrender three.scene --sample-range 4 -o x.exr
refused 'an empty range' 'is an empty range' vrender three.scene --sample-range 4:4 -o x.exr
scene hot.scene white.medium 4 'lights = ( { type = "environment"; radiance = 1e9; } );'
for r in 0:3 3:6; do vrender hot.scene --sample-range $r -o hot$r.exr; done
refused 'more light than a film holds, in the sum' 'too strong' exr-merge -o x.exr hot0:3.exr hot3:6.exr
is '' "$(ls x.exr* 2>/dev/null)" 'no image appears under its name'

# ---- a film read and written in mid-run goes on as if it had not been

for backend in c opencl; do
	rm -f half?.exr whole.exr
	film_mid_run $backend three.scene
	ok $? "$backend: read in mid-run, a film is as it was, and goes on to what one run gives"
	vrender three.scene --transport explicit --sample-range 0:4 -o part.exr
	cmp half1.exr half2.exr && imgcmp --max 0 half1.exr part.exr >/dev/null
	ok $? "$backend: finished twice, it is the same image, that of its samples"
	vrender three.scene --transport explicit --sample-range 0:8 -o part.exr
	imgcmp --max 0 whole.exr part.exr >/dev/null
	ok $? "$backend: and so it is when all are in"
done

# ---- spectral layers

vrender three.scene --samples 4 --spectral -o spectral.exr
ok "$(spectral_colours spectral.exr >got; echo $?)" "the wavelengths' colours are the image's: $(cat got)"
scene coloured.scene three.medium 24 'lights = ( { type = "sun"; direction = [-0.6, -1.0, -0.3]; irradiance = [3.0, 1.0, 0.2]; } );'
vrender coloured.scene --samples 4 --spectral -o spectral.exr
ok "$(spectral_colours spectral.exr >got; echo $?)" "of a coloured light, by three wavelengths: $(cat got)"
many='0.40 0.42 0.44 0.46 0.48 0.50 0.52 0.54 0.56 0.58 0.60'
# shellcheck disable=SC2086
{
	hg 0.3 $many >many.phase
	cube many.medium 1e6 0.9 many.phase $many
}
scene many.scene many.medium 24 "$lights"
vrender many.scene --samples 32 --spectral -o many.exr
ok "$(spectral_colours many.exr >got; echo $?)" "with paths that carry a part of them each too: $(cat got)"
oiiotool --info -v many.exr >info.txt
is 'spectralLayoutVersion: "1.0" emissiveUnits: "W.m^-2.sr^-1"' \
	"$(sed -n 's/^ *\(spectralLayoutVersion.*\)/\1/p' info.txt) $(sed -n 's/^ *\(emissiveUnits.*\)/\1/p' info.txt)" 'the layout is named'
grep -q 'S0.400,000000nm.*S0.600,000000nm' info.txt
ok $? 'and so are the channels'
done_testing
