//! Counting sort of items by their group.

/// Returns the items sorted by group (stable within a group) and the start of each group: the items of group k are
/// `all[starts[k]..starts[k + 1]]`.
pub(super) fn groups<T: Copy + Default>(
    groups: usize,
    all: impl Iterator<Item = (u32, T)> + Clone,
) -> (Vec<T>, Vec<usize>) {
    let mut starts = vec![0; groups + 1];
    all.clone().for_each(|(group, _)| starts[group as usize + 1] += 1);
    (0..groups).for_each(|k| starts[k + 1] += starts[k]);
    let mut next = starts.clone();
    let mut sorted = vec![T::default(); starts[groups]];
    for (group, one) in all {
        let at = &mut next[group as usize];
        sorted[*at] = one;
        *at += 1;
    }
    (sorted, starts)
}
