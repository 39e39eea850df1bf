//! Disturbances of a march: derivatives of its end by its beginning.

use super::stages::add;
use super::step_map::StepMap;
use crate::dae::Dae;

/// Number of disturbances propagated at once.
const BLOCK: usize = 64;

/// Receives the index of a stage, and disturbances of unknowns and of rates there.
pub(super) type StageWatcher<'a> = &'a mut dyn FnMut(usize, [&[f64]; 2]);

impl<D: Dae> StepMap<D> {
    /// `[E36]` Propagates disturbances of the differential unknowns from the first to the last time along the last march. `block`
    /// contains them one after the other, each with an entry for every unknown. Entries of algebraic unknowns are ignored and returned as
    /// zero.
    ///
    /// ```text
    /// ∂F/∂y δYᵢ + ∂F/∂y' δKᵢ = 0     δYᵢ = δyₙ + h Σⱼ aᵢⱼ δKⱼ     δyₙ₊₁ = δYₛ
    /// (∂F/∂y + 1/(hγ) ∂F/∂y') hγ δKᵢ = -∂F/∂y (δyₙ + h Σ_{j<i} aᵢⱼ δKⱼ)
    /// ```
    ///
    /// These are the differentiated stages of [`super`]: exact for the steps taken, not for the flow they approximate.
    pub fn propagate(&mut self, block: &mut [f64]) {
        let n = self.mask.len();
        assert!(block.len().is_multiple_of(n), "disturbances of another system");
        self.work.disturbances += (block.len() / n) as u64;
        for part in block.chunks_mut(n * BLOCK) {
            self.carry(part, &mut |_, out| out.fill(0.0), &mut |_| {}, &mut |_, _| {});
        }
    }

    /// Like [`StepMap::propagate`], for a few disturbances; `look` receives them at the beginning and at the end of every step.
    pub fn propagate_by_steps(&mut self, block: &mut [f64], look: &mut dyn FnMut(&[f64])) {
        let n = self.mask.len();
        let count = block.len() / n;
        assert!(
            block.len() == count * n && count <= BLOCK,
            "disturbances of another system, or too many"
        );
        self.work.disturbances += count as u64;
        self.carry(block, &mut |_, out| out.fill(0.0), look, &mut |_, _| {});
    }

    /// Propagates disturbances. `force` writes the negative forcing of a stage, for every column. `look` receives the disturbances at the
    /// beginning and at the end of every step, `stage` those of all unknowns and of their rates at every stage.
    pub(super) fn carry(
        &mut self,
        d: &mut [f64],
        force: &mut dyn FnMut(usize, &mut [f64]),
        look: &mut dyn FnMut(&[f64]),
        stage: StageWatcher<'_>,
    ) {
        let s = self.tableau.stages;
        let keep = |mask: &[f64], v: &mut [f64]| {
            for column in v.chunks_mut(mask.len()) {
                column.iter_mut().zip(mask).for_each(|(v, m)| *v *= m);
            }
        };
        keep(&self.mask, d);
        look(d);
        let mut k: Vec<Vec<f64>> = vec![vec![0.0; d.len()]; s];
        let mut values = vec![0.0; d.len()];
        force(0, &mut k[0]);
        self.answer(0, d, &mut k[0]);
        for (at, value) in values.iter_mut().enumerate() {
            let mask = self.mask[at % self.mask.len()];
            *value = d[at] + (1.0 - mask) * k[0][at];
        }
        keep(&self.mask, &mut k[0]);
        stage(0, [&values, &k[0]]);
        let mut base = vec![0.0; d.len()];
        for step in 0..self.times.len() - 1 {
            let h = self.times[step + 1] - self.times[step];
            let scale = h * self.tableau.gamma();
            for i in 1..s {
                base.copy_from_slice(d);
                for (j, k) in k.iter().enumerate().take(i) {
                    add(&mut base, h * self.tableau.a[i][j], k);
                }
                let slot = 1 + step * (s - 1) + i - 1;
                force(slot, &mut k[i]);
                self.answer(slot, &base, &mut k[i]);
                values.copy_from_slice(&base);
                add(&mut values, 1.0, &k[i]);
                keep(&self.mask, &mut k[i]);
                k[i].iter_mut().for_each(|k| *k /= scale);
                stage(slot, [&values, &k[i]]);
            }
            d.copy_from_slice(&base);
            add(d, scale, &k[s - 1]);
            look(d);
            k.swap(0, s - 1);
        }
    }

    /// `out = A⁻¹ (out - ∂F/∂y v)` of a slot, for every column.
    fn answer(&mut self, slot: usize, v: &[f64], out: &mut [f64]) {
        let n = self.mask.len();
        let slot = &mut self.slots[slot];
        let pattern = self.equations.dae.pattern();
        for (out, v) in out.chunks_mut(n).zip(v.chunks(n)) {
            for (column, v) in v.iter().enumerate().filter(|(_, v)| **v != 0.0) {
                for entry in pattern.column(column) {
                    out[pattern.rows[entry] as usize] -= slot.of_y[entry] * v;
                }
            }
        }
        slot.klu.solve_block(out);
        self.work.linear_solves += (v.len() / n) as u64;
    }
}
