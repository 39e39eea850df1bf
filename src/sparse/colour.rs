//! Column coloring: columns without a common row may be differentiated together.

use super::Pattern;

/// Colour of each column (greedy, in the given order) and the number of colours: columns of one colour share no row.
pub fn colours(pattern: &Pattern) -> (Vec<usize>, usize) {
    let n = pattern.columns();
    let mut columns_of_row = vec![Vec::new(); n];
    for j in 0..n {
        for &row in &pattern.rows[pattern.column(j)] {
            columns_of_row[row as usize].push(j);
        }
    }
    let mut colour = vec![usize::MAX; n];
    let mut taken_by = Vec::new();
    for j in 0..n {
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
