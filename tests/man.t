#!/bin/sh
# The manual: every page is clean, every tool has one that knows its options, and every example runs.
#
# An example is a line that begins with "$ " in a literal display under EXAMPLES (a trailing backslash continues it). The examples
# of a display run one after the other by sh in an empty folder, must exit 0 and write nothing to stderr. Lines beneath them are
# what they print, compared but for the amount of white space; a display without such lines may print anything.
# shellcheck source=tests/lib.sh
. "$(dirname "$0")/lib.sh"
n=0
count() { n=$((n + $1)); }

# A page as plain text.
plain() { mandoc -T ascii -O width=200 "$1" | sed "s/.$(printf '\b')//g"; }

# examples PREFIX: split the page on standard input into PREFIX.1.sh, PREFIX.1.want, ...
examples() {
	awk -v prefix="$1" '
		/^[A-Z]/ { inside = $0 == "EXAMPLES"; shown = 0; next }
		!inside { next }
		{ match($0, /^ */); indent = RLENGTH }
		more { sub(/^ */, ""); more = sub(/\\$/, ""); printf (more ? "%s " : "%s\n"), $0 >script; next }
		/^ *\$ / && (!shown || indent == margin) {
			if (!shown) { shown = 1; margin = indent; i++; script = prefix "." i ".sh"; want = prefix "." i ".want"; printf "" >want }
			sub(/^ *\$ /, ""); more = sub(/\\$/, ""); printf (more ? "%s " : "%s\n"), $0 >script; next
		}
		!shown { next }
		$0 != "" && indent < margin { shown = 0; next }
		{ print >want }'
}

# White space as it may.
loosely() { sed 's/[[:space:]][[:space:]]*/ /g; s/^ //; s/ $//' "$1" | sed -e :a -e '/^\n*$/{$d;N;ba' -e '}'; }

for page in "$top"/man/*.[1-9]; do
	name=$(basename "$page")
	mandoc -T lint -W warning "$page" >"$tmp/lint" 2>&1
	ok $? "$name is clean"
	sed 's/^/# /' "$tmp/lint"
	plain "$page" >"$tmp/plain"
	needed='NAME DESCRIPTION SEE.ALSO'
	case $name in *.1) needed='NAME SYNOPSIS DESCRIPTION EXIT.STATUS EXAMPLES SEE.ALSO' ;; esac
	missing=
	for s in $needed; do grep -q "^$s\$" "$tmp/plain" || missing="$missing $s"; done
	is '' "$missing" "$name has the sections it needs"
	examples "$tmp/$name" <"$tmp/plain"
	count 2
	case $name in *.1) ok "$([ -f "$tmp/$name.1.sh" ]; echo $?)" "$name has an example"; count 1 ;; esac
	for script in "$tmp/$name".*.sh; do
		[ -f "$script" ] || continue
		label=$(basename "$script" .sh)
		rm -rf "$tmp/folder"
		mkdir "$tmp/folder"
		(cd "$tmp/folder" && exec sh -e "$script") >"$tmp/out" 2>"$tmp/err" </dev/null
		status=$?
		loosely "$tmp/$label.want" >"$tmp/want"
		if [ -s "$tmp/want" ]; then loosely "$tmp/out" >"$tmp/got"; else : >"$tmp/got"; fi
		if [ $status -eq 0 ] && ! [ -s "$tmp/err" ] && cmp -s "$tmp/want" "$tmp/got"; then
			printf 'ok - example %s: %s\n' "$label" "$(head -1 "$script" | tr '#' ' ')"
		else
			echo "not ok - example $label, exit $status"
			cat "$script" "$tmp/err" | sed 's/^/# /'
			diff -u "$tmp/want" "$tmp/got" | sed 's/^/# /'
		fi
		count 1
	done
done

for source in "$top"/tools/*.c; do
	t=$(basename "$source" .c)
	page=$top/man/$t.1
	ok "$([ -f "$page" ]; echo $?)" "$t has a page"
	count 1
	[ -f "$page" ] || continue
	# What --help lists, and what the page has under .It Fl; --help and --version stand in motes(7).
	"$t" --help | sed -n 's/^  \(-[-a-z0-9]*\).*/\1/p' | grep -vxE -e '--(help|version)' | sort -u >"$tmp/has"
	sed -n 's/^\.It Fl \([-a-z0-9]*\).*/-\1/p' "$page" | sort -u >"$tmp/says"
	is "$(cat "$tmp/has")" "$(cat "$tmp/says")" "$t.1 lists its options, and no others"
	plain "$page" | sed -n '/^SYNOPSIS/,/^DESCRIPTION/p' >"$tmp/synopsis"
	absent=
	while read -r option; do grep -qF -e "$option" "$tmp/synopsis" || absent="$absent $option"; done <"$tmp/has"
	is '' "$absent" "and its synopsis has them all"
	count 2
done
plan $n
