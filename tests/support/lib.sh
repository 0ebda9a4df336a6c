# shellcheck shell=sh
# TAP for plain sh. A test sources this, reports with ok, is and refused, and ends with done_testing: one that dies before has no plan,
# and prove fails it. So it does where a test was told in a subshell, which does not count.
# The programs under test are first on the PATH, then those that tests share; the test is in $tmp, a folder of its own.
set -u
: "${MOTES_BUILD:=build}"
top=$(cd "$(dirname "$0")/../.." && pwd)
case $MOTES_BUILD in /*) ;; *) MOTES_BUILD=$top/$MOTES_BUILD ;; esac
PATH=$MOTES_BUILD/bin:$MOTES_BUILD/tests/support:$PATH
# shellcheck disable=SC2034
data=$top/tests/data
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
export PATH LC_ALL=C OMP_NUM_THREADS=2
export XDG_CACHE_HOME=/dev/null    # the user's caches are not a test's
# PoCL's own cache goes by what was compiled, so that all tests may share it: a kernel takes seconds to compile.
export POCL_CACHE_DIR="$MOTES_BUILD/tests/pocl"
mkdir -p "$POCL_CACHE_DIR"
# For the sanitizers: their own exit status 1 would read as "compared and different"; what the drivers of OpenCL leak is not ours.
export ASAN_OPTIONS="${ASAN_OPTIONS:-exitcode=99}"
export LSAN_OPTIONS="${LSAN_OPTIONS:-suppressions=$top/tests/support/leaks:print_suppressions=0}"

cd "$tmp" || exit 2
# shellcheck source=tests/support/cpu.sh
. "$top/tests/support/cpu.sh"

tests_run=0 tests_failed=0
# ok STATUS NAME: passes where STATUS is 0.
ok() {
	tests_run=$((tests_run + 1))
	if [ "$1" -eq 0 ]; then echo "ok $tests_run - $2"; else
		tests_failed=$((tests_failed + 1))
		echo "not ok $tests_run - $2"
	fi
}
# skip NAME WHY
skip() { ok 0 "$1 # skip $2"; }
# done_testing: the plan, counted, and the exit status.
done_testing() {
	echo "1..$tests_run"
	[ $tests_run -gt 0 ] && [ $tests_failed -eq 0 ]
	exit
}

# is WANTED GOT NAME: passes where the two texts are equal.
is() {
	if [ "$1" = "$2" ]; then ok 0 "$3"; else
		ok 1 "$3"
		printf '%s\n' "$1" | sed 's/^/# wanted: /'
		printf '%s\n' "$2" | sed 's/^/# got:    /'
	fi
}

# refused NAME PATTERN COMMAND..: the command exits 2 with one line on stderr, which matches PATTERN, and prints nothing.
# Standard input of the command is that of the call.
refused() {
	name=$1 pattern=$2
	shift 2
	"$@" >"$tmp/.out" 2>"$tmp/.err"
	status=$?
	lines=$(wc -l <"$tmp/.err")
	if [ $status -eq 2 ] && [ "$lines" -eq 1 ] && grep -qE -e "$pattern" "$tmp/.err" && ! [ -s "$tmp/.out" ]; then
		ok 0 "$name"
	else
		ok 1 "$name"
		echo "# exit $status, $(wc -c <"$tmp/.out") bytes on stdout, stderr wanted to match: $pattern"
		sed 's/^/# /' "$tmp/.err"
	fi
}

# golden NAME FILE [tabcmp or imgcmp options]: FILE equals tests/golden/NAME; GOLDEN=update rewrites it.
# Text is compared to the byte, tables and images within the options' tolerance.
golden() {
	name=$1 file=$2
	shift 2
	want=$top/tests/golden/$name
	if [ "${GOLDEN:-}" = update ]; then cp "$file" "$want"; fi
	case $name in
	*.tab) tabcmp "$@" "$want" "$file" >"$tmp/.cmp" 2>&1 ;;
	*.exr) imgcmp "$@" "$want" "$file" >"$tmp/.cmp" 2>&1 ;;
	*) diff -u "$want" "$file" >"$tmp/.cmp" 2>&1 ;;
	esac
	status=$?
	ok $status "golden $name"
	[ $status -eq 0 ] || head -20 "$tmp/.cmp" | sed 's/^/# /'
}
