//! Sorting networks for a few numbers.
//!
//! K. E. Batcher's merge exchange (Knuth, The Art of Computer Programming 3, section 5.2.2, algorithm M) compares the
//! same pairs for any input. With a number of elements known at compile time they stay in registers.

/// Sorts up to 12 numbers.
#[inline(always)]
pub(super) fn sort_few<const N: usize>(numbers: [u64; N]) -> [u64; N] {
    const { assert!(N <= MOST) };
    let (pairs, count) = const { merge_exchange(N) };
    let mut sorted = numbers;
    for &(i, j) in &pairs[..count] {
        let (a, b) = (sorted[i], sorted[j]);
        (sorted[i], sorted[j]) = (a.min(b), a.max(b));
    }
    sorted
}

const MOST: usize = 12;
const MOST_PAIRS: usize = 41;

/// The pairs for `n` numbers, and their count.
const fn merge_exchange(n: usize) -> ([(usize, usize); MOST_PAIRS], usize) {
    let mut pairs = [(0, 0); MOST_PAIRS];
    let mut count = 0;
    let largest = n.next_power_of_two() / 2;
    let mut p = largest;
    while p > 0 {
        let (mut q, mut r, mut d) = (largest, 0, p);
        loop {
            let mut i = 0;
            while i + d < n {
                if i & p == r {
                    pairs[count] = (i, i + d);
                    count += 1;
                }
                i += 1;
            }
            if q == p {
                break;
            }
            (d, q, r) = (q - p, q / 2, p);
        }
        p /= 2;
    }
    (pairs, count)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A network that sorts all sequences of zeros and ones sorts every sequence (Knuth, theorem Z).
    fn all_zeros_and_ones<const N: usize>() {
        for bits in 0..1u64 << N {
            let numbers: [u64; N] = std::array::from_fn(|i| bits >> i & 1);
            let sorted = sort_few(numbers);
            assert!(sorted.is_sorted(), "{numbers:?}");
            assert_eq!(sorted.iter().sum::<u64>(), numbers.iter().sum::<u64>());
        }
    }

    #[test]
    fn all_zeros_and_ones_come_in_order() {
        all_zeros_and_ones::<1>();
        all_zeros_and_ones::<2>();
        all_zeros_and_ones::<4>();
        all_zeros_and_ones::<6>();
        all_zeros_and_ones::<8>();
        all_zeros_and_ones::<10>();
        all_zeros_and_ones::<11>();
        all_zeros_and_ones::<12>();
    }
}
