// What q_follow_remainder takes of shifts and masks: sentences of the numbers, for that proof alone.

#ifndef STILLSPIN_TESTS_PROVE_REST_H
#define STILLSPIN_TESTS_PROVE_REST_H

/*@ axiomatic Rest {
      axiom masked: \forall integer x, m; 0 <= x && 0 <= m ==> 0 <= (x & m) <= m && (x & m) <= x;
      axiom nothing: \forall integer x, n; 0 <= n && 0 <= x < (1 << n) ==> (x >> n) == 0;
      axiom one: \forall integer x, n; 0 <= n && (1 << n) <= x < 2 * (1 << n) ==> (x >> n) == 1;
      axiom widths: \forall integer n; 0 <= n <= 24 ==> 1 <= (1 << n) <= 16777216;
    } */

#endif
