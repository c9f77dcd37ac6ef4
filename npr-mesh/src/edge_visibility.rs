//! What a file says about its edges, from what it says of the sides of faces.

use crate::edges::{Edge, Edges, NO_FACE};
use crate::{Model, SideVisibility};

/// Per edge of [`Edges::edges`] what its sides say together: [`SideVisibility::Hard`] if one of them is hard, else
/// [`SideVisibility::Unstated`] if the file says nothing of one of them, else [`SideVisibility::Silhouette`] if one is a
/// silhouette, else [`SideVisibility::Hidden`]. Empty if the model's [`Model::side_visibility`] is.
///
/// `edges`: of this model.
pub fn edge_visibility(model: &Model, edges: &Edges) -> Vec<SideVisibility> {
    if model.side_visibility.is_empty() {
        return Vec::new();
    }
    let mut further = edges.further_faces.iter().peekable();
    let of_edge = |(number, edge): (u32, &Edge)| {
        let mut found = edge.faces().into_iter().filter(|&face| face != NO_FACE).collect::<Vec<_>>();
        found.extend(std::iter::from_fn(|| further.next_if(|(of, _)| *of == number)).map(|&(_, face)| face));
        let sides = found.iter().flat_map(|&face| sides_between(model, edges, face, edge.ends));
        let joined = sides.reduce(joined).unwrap_or_default();
        // A single side may be stated as the repetition of one that is not among the faces.
        if joined == SideVisibility::RepeatedHard { SideVisibility::Hard } else { joined }
    };
    (0u32..).zip(&edges.edges).map(of_edge).collect()
}

/// What a face says of its sides between two vertices.
fn sides_between(model: &Model, edges: &Edges, face: u32, ends: [u32; 2]) -> impl Iterator<Item = SideVisibility> {
    let corners = model.faces[face as usize].map(|vertex| edges.representative[vertex as usize]);
    let visibility = model.side_visibility[face as usize];
    let is_between = move |&side: &usize| {
        let [from, to] = [corners[side], corners[(side + 1) % 3]];
        [from, to] == ends || [to, from] == ends
    };
    (0..3).filter(is_between).map(move |side| visibility[side])
}

fn joined(a: SideVisibility, b: SideVisibility) -> SideVisibility {
    use SideVisibility::{Hard, Hidden, RepeatedHard, Silhouette, Unstated};
    match (a, b) {
        (Hard | RepeatedHard, _) | (_, Hard | RepeatedHard) => Hard,
        (Unstated, _) | (_, Unstated) => Unstated,
        (Silhouette, _) | (_, Silhouette) => Silhouette,
        (Hidden, Hidden) => Hidden,
    }
}
