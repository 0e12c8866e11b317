use dla::{Checkpoint, CheckpointError};

/// Maximum number of blocks; a power of two.
const MOST: usize = 1024;

/// A series at equal distances in time, in constant memory: sums and extremes of at most 1024 blocks of equal length.
///
/// At 1024 blocks, neighbouring blocks are merged in pairs and are twice as long: from 1024 values on there are always 512 to 1024
/// blocks, for any length of the series. The order of the values within a block is lost.
#[derive(Debug, Clone, PartialEq)]
pub struct Blocks {
    /// Number of values of a block.
    length: u64,
    /// The full blocks.
    full: Vec<DriftBlock>,
    /// The block that is being filled, and the number of its values.
    last: DriftBlock,
    filled: u64,
    /// The time of the first value and of the last (s).
    times: [f64; 2],
    count: u64,
}

/// Sum and extremes of the values of a block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DriftBlock {
    sum: f64,
    pub(super) min: f64,
    pub(super) max: f64,
}

impl DriftBlock {
    const EMPTY: Self = Self { sum: 0.0, min: f64::INFINITY, max: f64::NEG_INFINITY };

    fn with(self, other: Self) -> Self {
        Self { sum: self.sum + other.sum, min: self.min.min(other.min), max: self.max.max(other.max) }
    }
}

impl Default for Blocks {
    fn default() -> Self {
        Self {
            length: 1,
            full: Vec::with_capacity(MOST),
            last: DriftBlock::EMPTY,
            filled: 0,
            times: [0.0; 2],
            count: 0,
        }
    }
}

impl Blocks {
    /// Adds the value at a time (s); the times are at equal distances.
    #[inline]
    pub fn add(&mut self, t: f64, value: f64) {
        if self.count == 0 {
            self.times[0] = t;
        }
        self.times[1] = t;
        self.count += 1;
        self.last = self.last.with(DriftBlock { sum: value, min: value, max: value });
        self.filled += 1;
        if self.filled == self.length {
            self.full.push(std::mem::replace(&mut self.last, DriftBlock::EMPTY));
            self.filled = 0;
            if self.full.len() == MOST {
                self.halve();
            }
        }
    }

    /// Makes one block of each two.
    fn halve(&mut self) {
        for i in 0..MOST / 2 {
            self.full[i] = self.full[2 * i].with(self.full[2 * i + 1]);
        }
        self.full.truncate(MOST / 2);
        self.length *= 2;
    }

    /// The full blocks, in the order of time.
    pub(super) fn full(&self) -> &[DriftBlock] {
        &self.full
    }

    /// The means of the full blocks.
    pub(super) fn means(&self) -> impl Iterator<Item = f64> {
        self.full.iter().map(|block| block.sum / self.length as f64)
    }

    /// The largest values in `PARTS` parts of equal length, in the order of time; `None` for fewer than four blocks a part.
    pub(crate) fn maxima<const PARTS: usize>(&self) -> Option<[f64; PARTS]> {
        let count = self.full.len();
        let part = |j: usize| &self.full[j * count / PARTS..(j + 1) * count / PARTS];
        let largest = |j| part(j).iter().fold(f64::NEG_INFINITY, |largest, block| largest.max(block.max));
        (count >= 4 * PARTS).then(|| std::array::from_fn(largest))
    }

    /// The time from a block to the next (s).
    pub(super) fn spacing(&self) -> f64 {
        let [first, last] = self.times;
        let steps = self.count.saturating_sub(1).max(1);
        (last - first) / steps as f64 * self.length as f64
    }

    /// Writes the blocks to a checkpoint.
    pub fn save(&self, checkpoint: &mut Checkpoint) {
        let all = || self.full.iter().chain(std::iter::once(&self.last));
        checkpoint.put_counts("blocks", &[self.length, self.filled, self.count]);
        checkpoint.put("block_times", &self.times);
        checkpoint.put("block_sums", &all().map(|block| block.sum).collect::<Vec<_>>());
        checkpoint.put("block_minima", &all().map(|block| block.min).collect::<Vec<_>>());
        checkpoint.put("block_maxima", &all().map(|block| block.max).collect::<Vec<_>>());
    }

    /// The blocks that [`save`](Self::save) wrote.
    ///
    /// # Errors
    /// [`CheckpointError`] if the checkpoint has none.
    pub fn load(checkpoint: &Checkpoint) -> Result<Self, CheckpointError> {
        let [length, filled, count] = checkpoint.counts("blocks")?;
        let times = checkpoint.get("block_times")?;
        let sums = checkpoint.list("block_sums")?;
        let (minima, maxima) = (checkpoint.list("block_minima")?, checkpoint.list("block_maxima")?);
        let extremes = minima.into_iter().zip(maxima);
        let mut full: Vec<DriftBlock> =
            sums.into_iter().zip(extremes).map(|(sum, (min, max))| DriftBlock { sum, min, max }).collect();
        let last = full.pop().unwrap_or(DriftBlock::EMPTY);
        full.truncate(MOST - 1);
        Ok(Self { length: length.max(1), full, last, filled, times, count })
    }
}
