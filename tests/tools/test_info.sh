#!/bin/sh
# test_info.sh - what ted4info says of a worked example of annex B, whole: a summary, and a row for
# every element; -q says nothing; limits of work and memory. Prints lines as a cmocka program does;
# run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
need info ted4info
info() { "$TED4_BUILD/ted4info" "$@"; }
vector=conformance/vectors/worked/WRK-annex-b2.ted4

cat >"$out/want" <<'END'
conformance/vectors/worked/WRK-annex-b2.ted4: TED4, Main profile, level 1, 1514 bytes
anchors     2, moving 1
Gaussians   3, at most 2 per anchor
frames      5 at 25 per second
seconds     0 to 0.16
motion      bank; activation yes; view colour
space       origin 0 0 4, unit 2^1
background  #000040
hash        1af21759d995e4e10f623a1670a756c9
chunk  element                     bytes        %      symbols  bits/symbol
file   magic                           8    0.528
file   major                           1    0.066
file   minor                           1    0.066
file   profile                         1    0.066
file   level                           1    0.066
HEAD   frame                          20    1.321
HEAD   n_anchors                       4    0.264
HEAD   tile_size                       4    0.264
HEAD   n_offsets                       1    0.066
HEAD   feature_dim                     1    0.066
HEAD   motion                          1    0.066
HEAD   phi_dim                         1    0.066
HEAD   bank_rows                       4    0.264
HEAD   bank_dim                        2    0.132
HEAD   deform_layers                   1    0.066
HEAD   deform_width                    2    0.132
HEAD   temporal_mask                   1    0.066
HEAD   offset_mask                     1    0.066
HEAD   activation                      1    0.066
HEAD   view                            1    0.066
HEAD   head_layers                     1    0.066
HEAD   head_width                      2    0.132
HEAD   scale_domain                    1    0.066
HEAD   prior                           1    0.066
HEAD   pe_octaves                      1    0.066
HEAD   hyper_layers                    1    0.066
HEAD   hyper_width                     2    0.132
HEAD   n_slices                        1    0.066
HEAD   slice                           2    0.132
HEAD   ar_width                        2    0.132
HEAD   context_bits                    1    0.066
HEAD   step                           20    1.321
HEAD   frames                          4    0.264
HEAD   rate_num                        4    0.264
HEAD   rate_den                        4    0.264
HEAD   origin                         12    0.793
HEAD   exponent                        1    0.066
HEAD   background                      3    0.198
HEAD   reserved                        1    0.066
NETE   frame                          20    1.321
NETE   shift                          46    3.038
NETE   mode                            1    0.066
NETE   nete                          712   47.028
NETR   frame                          20    1.321
NETR   mode                            1    0.066
NETR   netr                          392   25.892
BANK   frame                          20    1.321
BANK   mode                            1    0.066
BANK   bank                            8    0.528
POSN   frame                          20    1.321
POSN   position                       12    0.793
TILE   frame                          20    1.321
TILE   tile_index                      4    0.264
TILE   dynamic_prob                    2    0.132
TILE   offset_prob                    12    0.793
TILE   size                           28    1.849
TILE   mask_substream                  4    0.264            6       5.3333
TILE   feature_substream 0             4    0.264            2      16.0000
TILE   feature_substream 1             6    0.396            2      24.0000
TILE   scaling_substream               6    0.396           12       4.0000
TILE   offset_substream                6    0.396            9       5.3333
TILE   phi_substream                   4    0.264            1      32.0000
TILE   tau_substream                   8    0.528            8       8.0000
ENDS   frame                          20    1.321
ENDS   ends_hash                      16    1.057
all                                 1514
END
# same NAME LINES ARGUMENT...: the program prints the first lines of that text, and no others.
same() {
    name=$1 lines=$2; shift 2
    info "$@" >"$out/said" 2>&1
    status=$?
    head -n "$lines" "$out/want" | cmp -s - "$out/said" && [ $status -eq 0 ] && ok "$name" ||
        fail "$name" "status $status: $(head -n "$lines" "$out/want" | diff - "$out/said")"
}
same budget 1000 --budget $vector
same summary 9 $vector
same quiet 0 -q $vector
cp $vector "$out/bad.ted4"
printf x >>"$out/bad.ted4"
expect quiet_refused 1 'con.' "$TED4_BUILD/ted4info" -q "$out/bad.ted4"

# W_E (specification 13.4) of the vector is 3020.
same work 9 --max-work 3020 $vector
expect less_work 3 '[limit.work]' "$TED4_BUILD/ted4info" --max-work 3019 $vector
same memory 9 --max-memory 1000000 $vector
expect less_memory 3 '[limit.memory]' "$TED4_BUILD/ted4info" --max-memory 1000 $vector
exit $bad
