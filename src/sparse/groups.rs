//! Things put together by the group that they belong to.

/// What belongs to each group, one after the other in the order in which it comes, and where each group begins: that of group k is
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
