//! Columns that share no row may be differentiated together.

use super::Pattern;

/// Colour of each column and the number of colours: columns of one colour share no row. `together` colours are used at a time.
///
/// Greedy, in the given order; where the longest row, which has a colour for each of its entries, would leave one time fewer, against it and by first rows
/// too.
pub fn colours(pattern: &Pattern, together: usize) -> (Vec<usize>, usize) {
    let times = |count: usize| count.div_ceil(together);
    let given: Vec<usize> = (0..pattern.columns()).collect();
    let mut best = greedy(pattern, &given);
    let least = times(longest_row(pattern));
    let first_row = |&j: &usize| pattern.rows[pattern.column(j)].first().copied();
    let (mut against, mut by_row) = (given.clone(), given);
    against.reverse();
    by_row.sort_by_key(first_row);
    for order in [against, by_row] {
        if times(best.1) > least {
            let other = greedy(pattern, &order);
            if times(other.1) < times(best.1) {
                best = other;
            }
        }
    }
    best
}

fn longest_row(pattern: &Pattern) -> usize {
    let rows = pattern.rows.iter().max().map_or(0, |last| *last as usize + 1);
    let mut entries = vec![0_usize; rows];
    pattern.rows.iter().for_each(|row| entries[*row as usize] += 1);
    entries.into_iter().max().unwrap_or(0)
}

/// In this order.
fn greedy(pattern: &Pattern, order: &[usize]) -> (Vec<usize>, usize) {
    let n = pattern.columns();
    let mut columns_of_row = vec![Vec::new(); n];
    for j in 0..n {
        for &row in &pattern.rows[pattern.column(j)] {
            columns_of_row[row as usize].push(j);
        }
    }
    let mut colour = vec![usize::MAX; n];
    let mut taken_by = Vec::new();
    for &j in order {
        for &row in &pattern.rows[pattern.column(j)] {
            for &other in &columns_of_row[row as usize] {
                if colour[other] != usize::MAX {
                    taken_by[colour[other]] = j;
                }
            }
        }
        let free = taken_by.iter().position(|&by| by != j).unwrap_or_else(|| {
            taken_by.push(usize::MAX);
            taken_by.len() - 1
        });
        colour[j] = free;
    }
    (colour, taken_by.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A path whose ends come first: greedy takes three colours in the given order, and two against it, as many as a row has entries.
    #[test]
    fn another_order_saves_a_time() {
        let pattern = Pattern::from_columns(&[vec![0], vec![2], vec![0, 1], vec![1, 2]]);
        assert_eq!(greedy(&pattern, &[0, 1, 2, 3]).1, 3);
        let (colour, count) = colours(&pattern, 1);
        assert_eq!(count, 2);
        for (a, b) in [(0, 2), (2, 3), (3, 1)] {
            assert_ne!(colour[a], colour[b]);
        }
        // three at a time are one time in any case
        assert_eq!(colours(&pattern, 3).1, 3);
    }
}
