// Vectors of the drive's arithmetic for any processor: the cases come from a generator with a fixed seed, the results
// go out as hashes. model.py makes the same cases and knows the results from the functions' definitions.

#ifndef STILLSPIN_TESTS_VECTORS_VECTORS_H
#define STILLSPIN_TESTS_VECTORS_VECTORS_H

/// Where a character goes; the platform's.
void put_char(char c);

/// One line for every block of cases: function, number of the block, hash of the results.
void run_vectors(void);

#endif
