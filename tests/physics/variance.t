#!/bin/sh
# variance.Y is the variance: its mean over seeds is that of the pixels over seeds, in media smooth and grainy, and for any range of samples.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"
# shellcheck source=tests/support/render.sh
. "$top/tests/support/render.sh"

view() { scene "$1.scene" "$2.medium" 16 "$3"; }
lights='lights = ( { type = "environment"; radiance = 0.2; }, { type = "sun"; direction = [-0.6, -1.0, -0.3]; irradiance = 3.14; } );'
suns='lights = ( { type = "sun"; direction = [-0.6, -1.0, -0.3]; irradiance = 3.14; angle = 20.0; },
	{ type = "sun"; direction = [1, -1, 0]; irradiance = 1.0; } );'
many='0.40 0.43 0.46 0.49 0.52 0.55 0.58 0.61 0.64 0.67'
hg 0 >0.phase
hg 0.9 >9.phase
# shellcheck disable=SC2086
hg 0 $many >many.phase
oiiotool --pattern fill:top=4,4,4:bottom=0,0,0 16x8 3 -d float -o sky.exr
cube absorbing.medium 1e6 0.2 0.phase
cube thin.medium 5e5 0.99 0.phase
cube thick.medium 5e6 0.99 0.phase
cube forward.medium 4e6 0.999 9.phase
# shellcheck disable=SC2086
cube many.medium 1e6 0.8 many.phase $many
xsections 8e8 7.9e8 >grains.xsect
grains grains.medium 10000 grains.xsect 9.phase
for m in absorbing thin thick forward grains many; do view $m $m "$lights"; done
view grid grains "$lights"
view suns thin "$suns"
view map thin 'lights = ( { type = "environment"; file = "sky.exr"; } );'

# By 200 seeds the ratios of eight of the scenes are 0.965 to 1.056; by these 40, 0.918 to 1.060. From the spread of samples taken as
# independent they would be up to 8.
{
	variance_seeds 3 1 40 absorbing.scene thin.scene thick.scene forward.scene suns.scene map.scene many.scene
	variance_seeds 0 1 40 grains.scene
	variance_seeds 2 1 40 grid.scene
} >ratios
is 45 "$(wc -l <ratios | tr -d ' ')" 'nine scenes, five ranges of samples'
while IFS='	' read -r what ratio; do
	awk -v r="$ratio" 'BEGIN { exit !(r >= 0.85 && r <= 1.2) }'
	ok $? "$what: $ratio of the variance"
done <ratios
done_testing
