# Density grids of the benchmarks: a NumPy array [z][y][x] of 128^3 f4 over the cube [-1, 1]^3, to standard output. Nothing is random.
# cloud:  heaps of spheres on a flat base, their surface moved in and out by sums of sines; about 0.7 within
# sparse: threads and balls, one where they are thickest; most voxels are exactly 0
# usage: perl density.pl cloud | sparse >grid.npy
use strict;
use warnings;
my $n = 128;
my @at = map { (2 * $_ + 1) / $n - 1 } 0 .. $n - 1;    # centres of the voxels along an axis
my @grid = (0) x $n**3;

sub cloud {
	my @heaps = ([0, -.1, 0, .48], [-.42, -.2, .1, .36], [.42, -.22, -.08, .36], [.1, -.22, .42, .34], [-.1, -.22, -.42, .34],
		[.12, .3, .06, .36], [-.22, .2, -.14, .32], [.3, .14, .26, .27], [.05, .58, 0, .22], [-.6, -.3, -.25, .2], [.62, -.3, .25, .2]);
	# sines along x, y and z: frequencies and phases by the golden section, each octave half as strong
	my @waves = map { my $k = $_; [map { my $a = $_; my $f = (5 + 7 * (($k * .618 + $a * .382) - int($k * .618 + $a * .382))) * 2**int($k / 4);
		[map { sin($f * $_ + 2.4 * $k + 1.1 * $a) } @at] } 0 .. 2] } 0 .. 15;
	for my $z (0 .. $n - 1) { for my $y (0 .. $n - 1) {
		my @row = map { .22 / 2**int($_ / 4) * $waves[$_][1][$y] * $waves[$_][2][$z] } 0 .. $#waves;
		for my $x (0 .. $n - 1) {
			my $in = -1;
			for (@heaps) {
				my $d = $_->[3] - sqrt(($at[$x] - $_->[0])**2 + ($at[$y] - $_->[1])**2 + ($at[$z] - $_->[2])**2);
				$in = $d if $d > $in;
			}
			my $base = 4 * ($at[$y] + .52);
			$in = $base if $base < $in;
			next if $in < -.25;
			my $noise = 0;
			$noise += $row[$_] * $waves[$_][0][$x] for 0 .. $#waves;
			my $d = 12 * ($in + .6 * $noise);
			next if $d <= 0;
			$d = 1 if $d > 1;
			$grid[($z * $n + $y) * $n + $x] = $d * (.7 + $noise > 1 ? 1 : .7 + $noise < .2 ? .2 : .7 + $noise);
		}
	} }
}

# ball X Y Z R: as dense as 1 - (d/R)^2 at the distance d of its centre, where nothing denser is
sub ball {
	my ($r, @c) = @_[3, 0 .. 2];
	my @low = map { int(($_ - $r + 1) / 2 * $n) } @c;
	my @high = map { int(($_ + $r + 1) / 2 * $n) } @c;
	for my $z ($low[2] .. $high[2]) { for my $y ($low[1] .. $high[1]) { for my $x ($low[0] .. $high[0]) {
		my $d = 1 - (($at[$x] - $c[0])**2 + ($at[$y] - $c[1])**2 + ($at[$z] - $c[2])**2) / $r**2;
		my $i = ($z * $n + $y) * $n + $x;
		$grid[$i] = $d if $d > $grid[$i];
	} } }
}

sub sparse {
	for my $k (0 .. 3) {
		for my $i (0 .. 999) {
			my $t = 6.2831853 * $i / 1000;
			ball(.8 * sin($t + $k), .8 * sin(2 * $t + 1.7 * $k) * cos(.5 * $k), .8 * cos(($k + 1) * $t + .9 * $k), .04);
		}
	}
	ball(@$_) for [.5, .1, .3, .13], [-.4, .5, .2, .11], [.1, -.6, .5, .12], [-.6, -.3, -.5, .1], [.2, .6, -.5, .12], [0, 0, 0, .1];
}

my $what = shift // '';
$what eq 'cloud' ? cloud() : $what eq 'sparse' ? sparse() : die "usage: perl density.pl cloud | sparse\n";
binmode STDOUT;
my $header = "{'descr': '<f4', 'fortran_order': False, 'shape': ($n, $n, $n), }";
$header .= ' ' x (117 - length $header) . "\n";
print "\x93NUMPY\1\0", pack('v', 118), $header, pack('f<*', @grid);
