//! Order of elimination by nested dissection of the graph of a pattern (METIS, Karypis & Kumar 1998).

use std::ptr;

use crate::sparse::c;

/// Separators that are tried at each level. Five instead of one take 1.5 times the operations out of the factors of random wirings.
const SEPARATORS: c::idx_t = 5;

/// Writes the order of a block of the matrix into `order`; KLU calls it. Returns 1, or 0 on failure.
///
/// # Safety
/// The arrays are those of a pattern of `n` columns, as KLU passes them.
pub unsafe extern "C" fn order(
    n: i64,
    starts: *mut i64,
    rows: *mut i64,
    order: *mut i64,
    _: *mut c::klu_l_common_struct,
) -> i64 {
    let columns = n as usize;
    // SAFETY: KLU passes `n + 1` starts, the rows of all columns, and room for `n` numbers.
    let (starts, rows, out) = unsafe {
        let starts = std::slice::from_raw_parts(starts, columns + 1);
        let rows = std::slice::from_raw_parts(rows, starts[columns] as usize);
        (starts, rows, std::slice::from_raw_parts_mut(order, columns))
    };
    let Some((mut first, mut neighbours)) = graph(starts, rows) else {
        return 0;
    };
    let mut options: [c::idx_t; c::METIS_NOPTIONS as usize] = [0; c::METIS_NOPTIONS as usize];
    let (mut forward, mut back): (Vec<c::idx_t>, Vec<c::idx_t>) = (vec![0; columns], vec![0; columns]);
    let mut count = columns as c::idx_t;
    // SAFETY: the arrays have the lengths that METIS expects; it only writes into the last two.
    let status = unsafe {
        c::METIS_SetDefaultOptions(options.as_mut_ptr());
        options[c::moptions_et_METIS_OPTION_NSEPS as usize] = SEPARATORS;
        c::METIS_NodeND(
            &mut count,
            first.as_mut_ptr(),
            neighbours.as_mut_ptr(),
            ptr::null_mut(),
            options.as_mut_ptr(),
            forward.as_mut_ptr(),
            back.as_mut_ptr(),
        )
    };
    if status != 1 {
        return 0;
    }
    for (to, from) in out.iter_mut().zip(&forward) {
        *to = i64::from(*from);
    }
    1
}

/// Neighbours of each column in the pattern and its transpose, without the column itself: starts of the lists, and the lists. None if they
/// are too many for the numbers of METIS.
fn graph(starts: &[i64], rows: &[i64]) -> Option<(Vec<c::idx_t>, Vec<c::idx_t>)> {
    let columns = starts.len() - 1;
    let mut lists: Vec<Vec<c::idx_t>> = vec![vec![]; columns];
    for column in 0..columns {
        for &row in &rows[starts[column] as usize..starts[column + 1] as usize] {
            if row as usize != column {
                lists[column].push(c::idx_t::try_from(row).ok()?);
                lists[row as usize].push(c::idx_t::try_from(column).ok()?);
            }
        }
    }
    let mut first = vec![0];
    let mut neighbours = vec![];
    for mut list in lists {
        list.sort_unstable();
        list.dedup();
        neighbours.append(&mut list);
        first.push(c::idx_t::try_from(neighbours.len()).ok()?);
    }
    Some((first, neighbours))
}
