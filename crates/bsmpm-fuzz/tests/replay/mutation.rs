//! Makes reproducible mutations of given inputs.

/// Bytes of a mutated input at most.
const LONGEST: usize = 8192;
/// Bytes that mean something to somebody.
const TELLING: &[u8] = b"\0\x01\x1e\x7f\x80\xff\n\",.-+eE0195[]{}=#_ ";

/// Draws a mutation at a time: half of a corpus' inputs, half of earlier mutations.
pub struct Mutator {
    corpus: Vec<Vec<u8>>,
    last: Vec<u8>,
    state: u64,
}

impl Mutator {
    pub fn new(corpus: Vec<Vec<u8>>) -> Self {
        Self {
            corpus,
            last: Vec::new(),
            state: 1,
        }
    }

    /// Uniform in 0..below, by the linear congruential generator of Knuth's MMIX.
    fn draw(&mut self, below: usize) -> usize {
        self.state = self
            .state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.state >> 33) as usize % below.max(1)
    }

    /// A corpus input, or random bytes.
    fn input(&mut self) -> Vec<u8> {
        if self.draw(16) == 0 {
            return (0..self.draw(512)).map(|_| self.draw(256) as u8).collect();
        }
        let number = self.draw(self.corpus.len());
        self.corpus[number].clone()
    }

    pub fn next(&mut self) -> Vec<u8> {
        let mut data = if self.draw(2) == 0 && !self.last.is_empty() {
            self.last.clone()
        } else {
            self.input()
        };
        for _ in 0..=self.draw(4) {
            self.mutate(&mut data);
        }
        data.truncate(LONGEST);
        self.last.clone_from(&data);
        data
    }

    fn mutate(&mut self, data: &mut Vec<u8>) {
        let at = self.draw(data.len());
        let end = (at + 1 + self.draw(16)).min(data.len());
        match self.draw(7) {
            0 if !data.is_empty() => data[at] ^= 1 << self.draw(8),
            1 if !data.is_empty() => data[at] = TELLING[self.draw(TELLING.len())],
            2 if !data.is_empty() => data[at] = self.draw(256) as u8,
            3 => data.insert(at, TELLING[self.draw(TELLING.len())]),
            4 if !data.is_empty() => drop(data.drain(at..end)),
            5 if !data.is_empty() => {
                let part = data[at..end].to_vec();
                let to = self.draw(data.len());
                data.splice(to..to, part);
            }
            _ => {
                let other = self.input();
                let from = self.draw(other.len());
                data.truncate(at);
                data.extend_from_slice(&other[from.min(other.len())..]);
            }
        }
    }
}
