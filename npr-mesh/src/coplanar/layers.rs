//! Decides which of several faces at one place are seen.

/// What decides about a face among others at its place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layer {
    /// Whether its front is on the side that the normal of the plane points to.
    pub front: bool,
    pub double_sided: bool,
    /// Whether it hides what lies behind, wherever it is.
    pub opaque: bool,
}

/// Whether a face is seen, from its own front and from its own back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Seen {
    pub front: bool,
    pub back: bool,
}

/// Per layer, given in the order of the file, whether it is seen.
///
/// On each side of the plane faces that turn their front to it are above those that show their back, and of these the
/// later in the file is above. All are seen down to the first opaque one.
pub(super) fn seen(layers: &[Layer]) -> Vec<Seen> {
    let mut seen: Vec<Seen> = layers.iter().map(|_| Seen { front: false, back: false }).collect();
    for side in [true, false] {
        let fronts = (0..layers.len()).rev().filter(|&i| layers[i].front == side);
        let backs = (0..layers.len()).rev().filter(|&i| layers[i].front != side && layers[i].double_sided);
        for layer in fronts.chain(backs) {
            let is_front = layers[layer].front == side;
            *(if is_front { &mut seen[layer].front } else { &mut seen[layer].back }) = true;
            if layers[layer].opaque {
                break;
            }
        }
    }
    seen
}

#[cfg(test)]
mod tests {
    use super::*;

    const UP: Layer = Layer { front: true, double_sided: true, opaque: true };
    const DOWN: Layer = Layer { front: false, ..UP };
    const BOTH: Seen = Seen { front: true, back: true };
    const FRONT: Seen = Seen { front: true, back: false };
    const BACK: Seen = Seen { front: false, back: true };
    const NEVER: Seen = Seen { front: false, back: false };

    #[test]
    fn of_faces_with_equal_windings_the_later_is_seen_from_both_sides() {
        assert_eq!(seen(&[UP, UP]), [NEVER, BOTH]);
        assert_eq!(seen(&[DOWN, DOWN, DOWN]), [NEVER, NEVER, BOTH]);
    }

    #[test]
    fn of_opposite_faces_each_is_seen_from_its_front() {
        assert_eq!(seen(&[UP, DOWN]), [FRONT, FRONT]);
        assert_eq!(seen(&[DOWN, UP, UP]), [FRONT, NEVER, FRONT]);
    }

    #[test]
    fn what_is_not_opaque_hides_nothing() {
        let glass = |of: Layer| Layer { opaque: false, ..of };
        assert_eq!(seen(&[UP, glass(UP)]), [BOTH, BOTH]);
        assert_eq!(seen(&[glass(UP), UP]), [NEVER, BOTH]);
        assert_eq!(seen(&[UP, glass(DOWN)]), [BOTH, FRONT]);
        assert_eq!(seen(&[glass(UP), glass(DOWN)]), [BOTH, BOTH]);
    }

    #[test]
    fn a_single_sided_face_hides_nothing_from_its_back() {
        let single = |of: Layer| Layer { double_sided: false, ..of };
        assert_eq!(seen(&[UP, single(UP)]), [BACK, FRONT]);
        assert_eq!(seen(&[single(UP), single(DOWN)]), [FRONT, FRONT]);
    }
}
