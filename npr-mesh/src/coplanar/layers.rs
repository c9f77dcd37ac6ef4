//! Visibility of faces that cover the same triangle.

/// The properties of a face that determine its visibility among others at its place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layer {
    /// Whether its front is on the side that the normal of the plane points to.
    pub front: bool,
    pub double_sided: bool,
    /// Whether it hides what lies behind, wherever it is.
    pub opaque: bool,
}

/// From which of its own sides a face is visible.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct VisibleSides {
    pub front: bool,
    pub back: bool,
}

/// Per layer, given in the order of the file: from which sides it is visible.
///
/// On each side of the plane faces that turn their front to it are above those that show their back, and of these the
/// later in the file is above. All are visible down to the first opaque one.
pub(super) fn visible_sides(layers: &[Layer]) -> Vec<VisibleSides> {
    let mut visible: Vec<VisibleSides> = layers.iter().map(|_| VisibleSides { front: false, back: false }).collect();
    for side in [true, false] {
        let fronts = (0..layers.len()).rev().filter(|&i| layers[i].front == side);
        let backs = (0..layers.len()).rev().filter(|&i| layers[i].front != side && layers[i].double_sided);
        for layer in fronts.chain(backs) {
            let is_front = layers[layer].front == side;
            *(if is_front { &mut visible[layer].front } else { &mut visible[layer].back }) = true;
            if layers[layer].opaque {
                break;
            }
        }
    }
    visible
}

#[cfg(test)]
mod tests {
    use super::*;

    const UP: Layer = Layer { front: true, double_sided: true, opaque: true };
    const DOWN: Layer = Layer { front: false, ..UP };
    const BOTH: VisibleSides = VisibleSides { front: true, back: true };
    const FRONT: VisibleSides = VisibleSides { front: true, back: false };
    const BACK: VisibleSides = VisibleSides { front: false, back: true };
    const NEVER: VisibleSides = VisibleSides { front: false, back: false };

    #[test]
    fn of_faces_with_equal_windings_the_later_is_seen_from_both_sides() {
        assert_eq!(visible_sides(&[UP, UP]), [NEVER, BOTH]);
        assert_eq!(visible_sides(&[DOWN, DOWN, DOWN]), [NEVER, NEVER, BOTH]);
    }

    #[test]
    fn of_opposite_faces_each_is_seen_from_its_front() {
        assert_eq!(visible_sides(&[UP, DOWN]), [FRONT, FRONT]);
        assert_eq!(visible_sides(&[DOWN, UP, UP]), [FRONT, NEVER, FRONT]);
    }

    #[test]
    fn what_is_not_opaque_hides_nothing() {
        let glass = |of: Layer| Layer { opaque: false, ..of };
        assert_eq!(visible_sides(&[UP, glass(UP)]), [BOTH, BOTH]);
        assert_eq!(visible_sides(&[glass(UP), UP]), [NEVER, BOTH]);
        assert_eq!(visible_sides(&[UP, glass(DOWN)]), [BOTH, FRONT]);
        assert_eq!(visible_sides(&[glass(UP), glass(DOWN)]), [BOTH, BOTH]);
    }

    #[test]
    fn a_single_sided_face_hides_nothing_from_its_back() {
        let single = |of: Layer| Layer { double_sided: false, ..of };
        assert_eq!(visible_sides(&[UP, single(UP)]), [BACK, FRONT]);
        assert_eq!(visible_sides(&[single(UP), single(DOWN)]), [FRONT, FRONT]);
    }
}
