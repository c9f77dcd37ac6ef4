//! Placement of labels beside points, so that they cover neither each other nor points.

/// An axis-parallel box, px; y points down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Box2 {
    /// The left border.
    pub left: f64,
    /// The upper border.
    pub top: f64,
    /// The right border.
    pub right: f64,
    /// The lower border.
    pub bottom: f64,
}

impl Box2 {
    /// A box around a point.
    pub fn around((x, y): (f64, f64), half_width: f64, half_height: f64) -> Self {
        Self { left: x - half_width, top: y - half_height, right: x + half_width, bottom: y + half_height }
    }

    /// Whether two boxes have common area.
    pub fn overlaps(&self, other: &Self) -> bool {
        self.left < other.right && other.left < self.right && self.top < other.bottom && other.top < self.bottom
    }

    /// Whether another box lies within this one.
    pub fn contains(&self, other: &Self) -> bool {
        self.left <= other.left && self.top <= other.top && other.right <= self.right && other.bottom <= self.bottom
    }

    /// The middle.
    pub fn center(&self) -> (f64, f64) {
        (0.5 * (self.left + self.right), 0.5 * (self.top + self.bottom))
    }

    /// The nearest point of the box.
    pub fn nearest(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (x.clamp(self.left, self.right), y.clamp(self.top, self.bottom))
    }
}

/// A label to be placed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Label {
    /// The point that it names.
    pub point: (f64, f64),
    /// Its width and height, px.
    pub size: (f64, f64),
}

/// What is in the way of labels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surroundings {
    /// Boxes that no label may cover, such as those of marks.
    pub marks: Vec<Box2>,
    /// Segments that labels should not cover, such as error bars.
    pub segments: Vec<[(f64, f64); 2]>,
}

/// A label farther from its point than this gets a leader line, px.
pub const LEADER_PX: f64 = 14.0;

/// Distances of candidates from the point, px.
const DISTANCES: [f64; 10] = [8.0, 11.0, 18.0, 27.0, 38.0, 52.0, 70.0, 92.0, 118.0, 150.0];
/// Directions of candidates.
const DIRECTIONS: usize = 16;
/// The cost of a direction other than to the right, of covering a segment, and of a leader that crosses a mark or a
/// label, in px of distance.
const AWAY_COST: f64 = 2.0;
const SEGMENT_COST: f64 = 30.0;
const CROSSING_COST: f64 = 40.0;

/// Places labels within `bounds`: none overlaps another or a mark. `None` for a label that there is no room for.
///
/// Greedy: the labels are placed in their order, each at the candidate of least cost.
pub fn place(labels: &[Label], around: &Surroundings, bounds: Box2) -> Vec<Option<Box2>> {
    let mut placed: Vec<Option<Box2>> = Vec::with_capacity(labels.len());
    for label in labels {
        let is_free = |candidate: &Box2| {
            bounds.contains(candidate)
                && !around.marks.iter().any(|mark| mark.overlaps(candidate))
                && !placed.iter().flatten().any(|other| other.overlaps(candidate))
        };
        let cost = |candidate: &Box2| {
            let leader = [label.point, candidate.nearest(label.point)];
            let distance = length(leader);
            let covered = around.segments.iter().filter(|segment| crosses(segment, candidate)).count();
            let is_own = |mark: &&Box2| mark.center() == label.point;
            let crossed = if distance > LEADER_PX {
                around.marks.iter().filter(|mark| !is_own(mark) && crosses(&leader, mark)).count()
                    + placed.iter().flatten().filter(|other| crosses(&leader, other)).count()
            } else {
                0
            };
            let (x, _) = candidate.center();
            let away = if x > label.point.0 { 0.0 } else { AWAY_COST };
            distance + away + SEGMENT_COST * covered as f64 + CROSSING_COST * crossed as f64
        };
        let near = near_candidates(label).filter(is_free);
        let best = near.map(|candidate| (cost(&candidate), candidate)).min_by(|a, b| a.0.total_cmp(&b.0));
        // Anywhere, if the surroundings of the point are full.
        let best = best.or_else(|| {
            let far = grid(label.size, bounds).filter(is_free);
            far.map(|candidate| (cost(&candidate), candidate)).min_by(|a, b| a.0.total_cmp(&b.0))
        });
        placed.push(best.map(|(_, candidate)| candidate));
    }
    placed
}

fn near_candidates(label: &Label) -> impl Iterator<Item = Box2> {
    let ((x, y), (width, height)) = (label.point, label.size);
    DISTANCES.into_iter().flat_map(move |distance| {
        (0..DIRECTIONS).map(move |direction| {
            let (sin, cos) = (direction as f64 * std::f64::consts::TAU / DIRECTIONS as f64).sin_cos();
            // The border that is turned to the point stays at the distance, for all directions.
            let center =
                (x + cos * distance + snapped(cos) * 0.5 * width, y - sin * distance - snapped(sin) * 0.5 * height);
            Box2::around(center, 0.5 * width, 0.5 * height)
        })
    })
}

/// −1, 0 or 1 for directions along an axis or a diagonal, in between for others.
fn snapped(component: f64) -> f64 {
    (component * std::f64::consts::SQRT_2).clamp(-1.0, 1.0)
}

fn grid((width, height): (f64, f64), bounds: Box2) -> impl Iterator<Item = Box2> {
    let steps =
        |from: f64, to: f64, step: f64| (0..).map(move |n| from + f64::from(n) * step).take_while(move |v| *v <= to);
    steps(bounds.left + 0.5 * width, bounds.right - 0.5 * width, 8.0).flat_map(move |x| {
        steps(bounds.top + 0.5 * height, bounds.bottom - 0.5 * height, 0.5 * height)
            .map(move |y| Box2::around((x, y), 0.5 * width, 0.5 * height))
    })
}

fn length([(x0, y0), (x1, y1)]: [(f64, f64); 2]) -> f64 {
    (x1 - x0).hypot(y1 - y0)
}

/// Whether a segment and a box meet: clips the segment by the four borders (Liang and Barsky, 1984).
fn crosses([(x0, y0), (x1, y1)]: &[(f64, f64); 2], area: &Box2) -> bool {
    let (dx, dy) = (x1 - x0, y1 - y0);
    let (mut enter, mut leave) = (0f64, 1f64);
    for (step, room) in [(-dx, x0 - area.left), (dx, area.right - x0), (-dy, y0 - area.top), (dy, area.bottom - y0)] {
        if step == 0.0 {
            if room < 0.0 {
                return false;
            }
        } else if step < 0.0 {
            enter = enter.max(room / step);
        } else {
            leave = leave.min(room / step);
        }
    }
    enter < leave
}
