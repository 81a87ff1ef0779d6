// The same of a shift to the right, which rounds down. For the proofs of the shifts alone: with products of two
// unknowns the prover goes astray elsewhere.

#ifndef STILLSPIN_TESTS_PROVE_FLOOR_H
#define STILLSPIN_TESTS_PROVE_FLOOR_H

/*@ axiomatic Floor {
      axiom share: \forall integer x, n; 0 <= n ==> (x >> n) * (1 << n) <= x < ((x >> n) + 1) * (1 << n);
    } */

#endif
