//! Look at a mesh, printed: what was found, patches and chains of the skin as tables, and the price of the model.

use crate::assembly::AssemblyPrice;
use crate::from_mesh::{MeshLook, MeshRole};

/// Largest number of patches, and of chains, that are listed.
const MOST_LISTED: usize = 40;

/// Look at a mesh as text.
pub(super) fn described(look: &MeshLook) -> String {
    let mut lines = look.found.clone();
    lines.extend(look.refusals.iter().map(|refusal| format!("REFUSED: {}", refusal.detail)));
    lines.push(format!("\nPatches: {} (name the node with --clamp-at or --contact-at)", look.patches.len()));
    lines.push(row(&["at node", "area", "radius", "axial", "nodes", "role"].map(str::to_owned)));
    for patch in look.patches.iter().take(MOST_LISTED) {
        let number = |x: Option<f64>| x.map_or("-".to_owned(), |x| format!("{x:.5}"));
        let at = if patch.at.is_empty() { "-".to_owned() } else { listed(&patch.at) };
        lines.push(row(&[
            at,
            format!("{:.5}", patch.area),
            number(patch.radius),
            number(patch.axial),
            patch.nodes.to_string(),
            patch.role.map_or(String::new(), role),
        ]));
    }
    lines.push(format!(
        "\nChains of sharp edges: {} (name two nodes with --contact-between)",
        look.chains.len()
    ));
    lines.push(row(&["from", "to", "length", "nodes", ""].map(str::to_owned)));
    for chain in look.chains.iter().take(MOST_LISTED) {
        let end =
            |place: Option<&u32>| place.map_or(String::new(), |&k| look.node_ids[k as usize].to_string());
        let (first, last) = (chain.nodes.first(), chain.nodes.last());
        let kind = if chain.cyclic {
            "on a cyclic face"
        } else if first == last {
            "closed"
        } else {
            ""
        };
        lines.push(row(&[
            end(first),
            end(last),
            format!("{:.5}", chain.length),
            chain.nodes.len().to_string(),
            kind.to_owned(),
        ]));
    }
    lines.push(format!("\n{}", priced(&look.price)));
    lines.join("\n")
}

fn role(role: MeshRole) -> String {
    match role {
        MeshRole::Low => "low face",
        MeshRole::High => "high face",
        MeshRole::Clamp => "clamp",
        MeshRole::Contact => "contact",
    }
    .to_owned()
}

fn listed(nodes: &[u64]) -> String {
    nodes.iter().map(u64::to_string).collect::<Vec<_>>().join(",")
}

fn row(cells: &[String]) -> String {
    let cells: Vec<String> = cells.iter().map(|cell| format!("{cell:>12}")).collect();
    cells.join(" ")
}

fn priced(price: &AssemblyPrice) -> String {
    let megabytes = |bytes: u64| bytes.div_ceil(1_000_000);
    format!(
        "Making the model: {} unknowns, about {:.1} s on two cores, {} MB of memory, a package of {} MB",
        price.unknowns,
        price.seconds,
        megabytes(price.memory_bytes),
        megabytes(price.package_bytes)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::from_mesh::{MeshSettings, look};

    /// Quarter of a square ring as one brick, which turns onto itself about z.
    const BRICK: &str = "*NODE\n1, 1, -1, 0\n2, 3, -3, 0\n3, 3, 3, 0\n4, 1, 1, 0\n5, 1, -1, 2\n6, 3, -3, 2\n7, 3, 3, 2\n8, 1, 1, 2\n\
                         *ELEMENT, TYPE=C3D8I, ELSET=ALL\n1, 1, 2, 3, 4, 5, 6, 7, 8\n";

    #[test]
    fn a_look_is_printed_as_tables() {
        let file = crate::mesh::read(BRICK.as_bytes(), &|_| Err(String::new())).unwrap();
        let text = described(&look(&file, &MeshSettings::of_look(b"{}").unwrap()).unwrap());
        let cells: Vec<Vec<&str>> = text.lines().map(|line| line.split_whitespace().collect()).collect();
        // The bore is 2 by 2, with its centre at x = 1; the faces above and below are trapezia of height 2.
        assert!(cells.contains(&vec!["1,4,5,8", "4.00000", "1.00000", "1.00000", "4", "clamp"]), "{text}");
        assert!(cells.contains(&vec!["1,2,3,4", "8.00000", "2.00000", "0.00000", "4"]), "{text}");
        assert!(
            text.contains("sectors: 4 (found)") && text.contains("REFUSED: element 1 has no material"),
            "{text}"
        );
        let cuts = cells.iter().filter(|row| row.last() == Some(&"face") && row.contains(&"cyclic"));
        assert_eq!(cuts.count(), 8, "{text}");
    }
}
