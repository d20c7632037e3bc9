//! Plans the elimination order by nested dissection (George, 1973; Liu, 1992). Separators, which split a box of nodes
//! into independent halves, have q layers of nodes (q: spline degree).

use super::factor;
use bsmpm::nodal::Nodal;
use std::ops::Range;

/// Number of unknowns below which a box is not divided further. Dividing smaller boxes costs more than it saves (tried
/// between 32 and 192 on plane grids).
const LEAF: usize = 64;

/// Elimination number of a component that is not an unknown.
pub const NONE: u32 = u32::MAX;

/// Unknowns that are eliminated together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Supernode {
    /// Elimination numbers of these unknowns.
    pub own: Range<usize>,
    /// Elimination numbers of later unknowns that couple with these or with their descendants, ascending.
    pub rim: Vec<u32>,
    /// Number of children: supernodes directly before this one (and its other descendants) whose update matrices it
    /// receives.
    pub children: usize,
    /// First descendant, or itself without children.
    pub first: usize,
    /// Positions of the rim in the front of the parent.
    pub above: Vec<usize>,
    /// Index in the factor at which its columns begin.
    pub start: usize,
}

impl Supernode {
    /// Returns the order of its front.
    pub fn rows(&self) -> usize {
        self.own.len() + self.rim.len()
    }

    /// Returns the index in the factor at which the columns of the next supernode begin.
    fn end(&self) -> usize {
        self.start + factor::entries(self.rows(), self.own.len())
    }
}

/// Elimination order, children before parents. The last supernode eliminates nothing: its rim are the unknowns shared
/// with other ranks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plan {
    /// Component by elimination number. The shared components come last, ascending.
    pub order: Vec<u32>,
    /// Elimination number by component, or [`NONE`].
    pub number: Vec<u32>,
    /// Supernodes.
    pub parts: Vec<Supernode>,
}

/// Nested dissection of a box of nodes.
struct Cutter<'a, const D: usize, const C: usize> {
    counts: [usize; D], // nodes of the window along each axis
    order: usize,       // distance at which nodes couple
    free: &'a [bool],
    plan: Plan,
    boxes: Vec<[Range<usize>; D]>, // of each supernode with its descendants
}

impl Plan {
    /// Creates the plan for the `free` components of a window of `counts` nodes with C components each. Nodes couple up
    /// to the distance `order`. Only this rank uses the box `inner`.
    pub fn new<const D: usize, const C: usize>(
        counts: [usize; D],
        order: usize,
        inner: &[Range<usize>; D],
        free: &[bool],
    ) -> Self {
        let plan = Plan {
            number: vec![NONE; free.len()],
            ..Plan::default()
        };
        let mut cutter = Cutter::<D, C> {
            counts,
            order,
            free,
            plan,
            boxes: Vec::new(),
        };
        let children = usize::from(cutter.cut(inner.clone()));
        let mut shared = Vec::new();
        each_node(&counts.map(|count| 0..count), |node| {
            if !(0..D).all(|axis| inner[axis].contains(&node[axis])) {
                shared.extend(cutter.unknowns(cutter.index(&node)));
            }
        });
        cutter.number(shared);
        cutter.rims();
        let Cutter { mut plan, .. } = cutter;
        let eliminated = plan.parts.last().map_or(0, |part| part.own.end);
        let start = plan.parts.last().map_or(0, Supernode::end);
        let rim = (eliminated as u32..plan.order.len() as u32).collect();
        let above = Vec::new();
        plan.parts.push(Supernode {
            own: eliminated..eliminated,
            rim,
            children,
            first: 0,
            above,
            start,
        });
        plan.hang();
        plan
    }

    /// Finds for every supernode its first descendant and the positions of its rim in the front of its parent.
    fn hang(&mut self) {
        for parent in 0..self.parts.len() {
            let children: Vec<usize> = self.children(parent).collect();
            self.parts[parent].first = children.last().map_or(parent, |&child| self.parts[child].first);
            let Supernode { own, rim, .. } = &self.parts[parent];
            let own = own.clone();
            let rim = rim.clone();
            for child in children {
                let mut at = 0;
                let mut above = Vec::with_capacity(self.parts[child].rim.len());
                for &number in &self.parts[child].rim {
                    if own.contains(&(number as usize)) {
                        above.push(number as usize - own.start);
                        continue;
                    }
                    at += rim[at..]
                        .iter()
                        .position(|&other| other == number)
                        .expect("a rim lies in the front above");
                    above.push(own.len() + at);
                }
                self.parts[child].above = above;
            }
        }
    }

    /// Iterates over the children of a supernode, the last one first.
    pub fn children(&self, parent: usize) -> impl Iterator<Item = usize> + use<'_> {
        let mut next = parent;
        (0..self.parts[parent].children).map(move |_| {
            let child = next - 1;
            next = self.parts[child].first;
            child
        })
    }

    /// Returns the elimination numbers of a supernode and its descendants.
    pub fn numbers_to(&self, root: usize) -> Range<usize> {
        self.parts[self.parts[root].first].own.start..self.parts[root].own.end
    }

    /// Returns the range in the factor of a supernode's columns and those of its descendants.
    pub fn columns_to(&self, root: usize) -> Range<usize> {
        self.parts[self.parts[root].first].start..self.parts[root].end()
    }

    /// Returns the count of numbers of the factor.
    pub fn entries(&self) -> usize {
        self.parts.last().map_or(0, |part| part.start)
    }

    /// Returns the number of unknowns that only this rank uses.
    pub fn eliminated(&self) -> usize {
        self.parts.last().map_or(0, |part| part.own.end)
    }

    /// Returns the components that other ranks also use.
    pub fn shared(&self) -> &[u32] {
        &self.order[self.eliminated()..]
    }

    /// Iterates over the elimination numbers of the rows of a supernode's front.
    pub fn front<'a>(&self, part: &'a Supernode) -> impl Iterator<Item = usize> + use<'a> {
        part.own.clone().chain(part.rim.iter().map(|&number| number as usize))
    }
}

impl<const D: usize, const C: usize> Cutter<'_, D, C> {
    /// Orders the unknowns of a box by nested dissection; `false` if it has none.
    fn cut(&mut self, region: [Range<usize>; D]) -> bool {
        let Some((region, unknowns)) = self.tight(&region) else {
            return false;
        };
        let (axis, length) = region
            .iter()
            .map(|range| range.len())
            .enumerate()
            .max_by_key(|(_, length)| *length)
            .unwrap();
        if unknowns <= LEAF || length < self.order + 2 {
            let all = self.components(&region);
            self.part(all, region, 0);
            return true;
        }
        let middle = self.middle(&region, axis);
        let upper = middle + self.order;
        let [low, separator, high] =
            [region[axis].start..middle, middle..upper, upper..region[axis].end].map(|along| {
                let mut piece = region.clone();
                piece[axis] = along;
                piece
            });
        let left = self.cut(low);
        let right = self.cut(high);
        let separator = self.components(&separator);
        self.part(separator, region, usize::from(left) + usize::from(right));
        true
    }

    /// Returns the smallest box around the unknowns of a box, and their number; `None` if there are none.
    fn tight(&self, region: &[Range<usize>; D]) -> Option<([Range<usize>; D], usize)> {
        let mut least = [usize::MAX; D];
        let mut most = [0; D];
        let mut count = 0;
        each_node(region, |node| {
            let free = self.unknowns(self.index(&node)).count();
            if free > 0 {
                count += free;
                for axis in 0..D {
                    (least[axis], most[axis]) = (least[axis].min(node[axis]), most[axis].max(node[axis] + 1));
                }
            }
        });
        (count > 0).then(|| (std::array::from_fn(|axis| least[axis]..most[axis]), count))
    }

    /// Returns the first layer of a separator across `axis` that leaves about equally many unknowns on either side.
    fn middle(&self, region: &[Range<usize>; D], axis: usize) -> usize {
        let start = region[axis].start;
        let mut layers = vec![0; region[axis].len()];
        each_node(region, |node| {
            layers[node[axis] - start] += self.unknowns(self.index(&node)).count()
        });
        let mut before = layers[0];
        let mut behind = layers[1 + self.order..].iter().sum::<usize>();
        let mut at = 1;
        while at + self.order + 1 < layers.len() && before < behind {
            before += layers[at];
            behind -= layers[at + self.order];
            at += 1;
        }
        start + at
    }

    /// Returns the index of a node of the window.
    fn index(&self, node: &[usize; D]) -> usize {
        (0..D).fold(0, |index, axis| index * self.counts[axis] + node[axis])
    }

    fn unknowns(&self, node: usize) -> impl Iterator<Item = usize> + '_ {
        Nodal::<C>::of(node).filter(|&component| self.free[component])
    }

    fn components(&self, region: &[Range<usize>; D]) -> Vec<usize> {
        let mut components = Vec::new();
        each_node(region, |node| components.extend(self.unknowns(self.index(&node))));
        components
    }

    fn part(&mut self, components: Vec<usize>, region: [Range<usize>; D], children: usize) {
        let start = self.plan.order.len();
        self.number(components);
        self.plan.parts.push(Supernode {
            own: start..self.plan.order.len(),
            children,
            ..Supernode::default()
        });
        self.boxes.push(region);
    }

    /// Gives the unknowns among `components` the next elimination numbers.
    fn number(&mut self, components: Vec<usize>) {
        for component in components.into_iter().filter(|&component| self.free[component]) {
            self.plan.number[component] = self.plan.order.len() as u32;
            self.plan.order.push(component as u32);
        }
    }

    /// Finds the rims: unknowns within the coupling distance of a supernode's box. All of them are eliminated later,
    /// because a separator is as wide as this distance.
    fn rims(&mut self) {
        let mut start = 0;
        for (part, region) in (0..).zip(&self.boxes) {
            let around: [Range<usize>; D] = std::array::from_fn(|axis| {
                let start = region[axis].start;
                let end = region[axis].end;
                start.saturating_sub(self.order)..(end + self.order).min(self.counts[axis])
            });
            let mut rim = Vec::new();
            each_node(&around, |node| {
                if !(0..D).all(|axis| region[axis].contains(&node[axis])) {
                    rim.extend(
                        self.unknowns(self.index(&node))
                            .map(|component| self.plan.number[component]),
                    );
                }
            });
            rim.sort_unstable();
            let part: &mut Supernode = &mut self.plan.parts[part];
            (part.rim, part.start) = (rim, start);
            start = part.end();
        }
    }
}

/// Visits the nodes of a box, axis 0 slowest.
fn each_node<const D: usize>(region: &[Range<usize>; D], mut visit: impl FnMut([usize; D])) {
    if region.iter().any(Range::is_empty) {
        return;
    }
    let mut node: [usize; D] = std::array::from_fn(|axis| region[axis].start);
    loop {
        visit(node);
        let mut axis = D;
        loop {
            if axis == 0 {
                return;
            }
            axis -= 1;
            node[axis] += 1;
            if node[axis] < region[axis].end {
                break;
            }
            node[axis] = region[axis].start;
        }
    }
}
