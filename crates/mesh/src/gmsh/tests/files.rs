//! Files of one mesh in each version and encoding.

/// Elements of one type: number of the type, entity or group, node lists.
pub(super) struct Block {
    pub(super) of: i32,
    pub(super) dimension: i32,
    pub(super) entity: i32,
    pub(super) elements: Vec<Vec<u64>>,
}

/// Mesh to be written.
pub(super) struct Mesh {
    pub(super) nodes: Vec<[f64; 3]>,
    pub(super) blocks: Vec<Block>,
}

/// Dimensions, numbers and names of physical groups; entities have the number of their group.
pub(super) const NAMES: &str = "$PhysicalNames\n2\n2 1 \"rim face\"\n3 1 \"blade\"\n$EndPhysicalNames\n";

fn words<T: ToString>(numbers: impl IntoIterator<Item = T>) -> String {
    numbers.into_iter().map(|number| number.to_string()).collect::<Vec<_>>().join(" ")
}

impl Mesh {
    fn count(&self) -> usize {
        self.blocks.iter().map(|block| block.elements.len()).sum()
    }

    fn numbered(&self) -> Vec<(usize, &Block, &Vec<u64>)> {
        let all = self.blocks.iter().flat_map(|block| block.elements.iter().map(move |nodes| (block, nodes)));
        all.enumerate().map(|(k, (block, nodes))| (k + 1, block, nodes)).collect()
    }

    pub(super) fn ascii_2(&self) -> Vec<u8> {
        let mut text = format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n{NAMES}$Nodes\n{}\n", self.nodes.len());
        for (k, node) in self.nodes.iter().enumerate() {
            text += &format!("{} {}\n", k + 1, words(node));
        }
        text += &format!("$EndNodes\n$Elements\n{}\n", self.count());
        for (id, block, nodes) in self.numbered() {
            text += &format!("{id} {} 2 {} 7 {}\n", block.of, block.entity, words(nodes));
        }
        (text + "$EndElements\n").into_bytes()
    }

    pub(super) fn binary_2(&self) -> Vec<u8> {
        let mut bytes = b"$MeshFormat\n2.2 1 8\n".to_vec();
        let int = |bytes: &mut Vec<u8>, x: u64| bytes.extend((x as i32).to_le_bytes());
        int(&mut bytes, 1);
        bytes.extend(format!("\n$EndMeshFormat\n{NAMES}$Nodes\n{}\n", self.nodes.len()).bytes());
        for (k, node) in self.nodes.iter().enumerate() {
            int(&mut bytes, k as u64 + 1);
            node.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
        }
        bytes.extend(format!("\n$EndNodes\n$Elements\n{}\n", self.count()).bytes());
        for (id, block, nodes) in self.numbered() {
            for x in [block.of as u64, 1, 2, id as u64, block.entity as u64, 7].iter().chain(nodes) {
                int(&mut bytes, *x);
            }
        }
        bytes.extend(b"\n$EndElements\n");
        bytes
    }

    pub(super) fn ascii_4(&self) -> Vec<u8> {
        let mut text = format!("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n{NAMES}$Entities\n0 0 1 1\n");
        text += "1 0 0 0 1 1 1 1 1 1 -5\n1 0 0 0 1 1 1 1 1 2 1 -2\n$EndEntities\n";
        let count = self.nodes.len();
        text +=
            &format!("$Nodes\n1 {count} 1 {count}\n2 1 1 {count}\n{}\n", words(1..=count).replace(' ', "\n"));
        for node in &self.nodes {
            text += &format!("{} 0.5 0.25\n", words(node));
        }
        let count = self.count();
        text += &format!("$EndNodes\n$Elements\n{} {count} 1 {count}\n", self.blocks.len());
        let mut id = 0;
        for Block { of, dimension, entity, elements } in &self.blocks {
            text += &format!("{dimension} {entity} {of} {}\n", elements.len());
            for nodes in elements {
                id += 1;
                text += &format!("{id} {}\n", words(nodes));
            }
        }
        (text + "$EndElements\n").into_bytes()
    }

    pub(super) fn binary_4(&self) -> Vec<u8> {
        let mut bytes = b"$MeshFormat\n4.1 1 8\n\x01\0\0\0\n$EndMeshFormat\n".to_vec();
        let int = |bytes: &mut Vec<u8>, x: i32| bytes.extend(x.to_le_bytes());
        let size = |bytes: &mut Vec<u8>, x: usize| bytes.extend((x as u64).to_le_bytes());
        bytes.extend(format!("{NAMES}$Entities\n").bytes());
        [0, 0, 1, 1].iter().for_each(|&x| size(&mut bytes, x));
        for bounding in [1, 2] {
            int(&mut bytes, 1);
            [0.0, 0.0, 0.0, 1.0, 1.0, 1.0_f64].iter().for_each(|x| bytes.extend(x.to_le_bytes()));
            size(&mut bytes, 1);
            int(&mut bytes, 1);
            size(&mut bytes, bounding);
            (0..bounding).for_each(|_| int(&mut bytes, -5));
        }
        bytes.extend(b"\n$EndEntities\n$Nodes\n");
        let count = self.nodes.len();
        [1, count, 1, count].iter().for_each(|&x| size(&mut bytes, x));
        [3, 1, 0].iter().for_each(|&x| int(&mut bytes, x));
        size(&mut bytes, count);
        (1..=count).for_each(|x| size(&mut bytes, x));
        self.nodes.iter().flatten().for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes.extend(b"\n$EndNodes\n$Elements\n");
        let count = self.count();
        [self.blocks.len(), count, 1, count].iter().for_each(|&x| size(&mut bytes, x));
        let mut id = 0;
        for block in &self.blocks {
            [block.dimension, block.entity, block.of].iter().for_each(|&x| int(&mut bytes, x));
            size(&mut bytes, block.elements.len());
            for nodes in &block.elements {
                id += 1;
                size(&mut bytes, id);
                nodes.iter().for_each(|&x| size(&mut bytes, x as usize));
            }
        }
        bytes.extend(b"\n$EndElements\n");
        bytes
    }

    /// Files of all four forms.
    pub(super) fn all(&self) -> [Vec<u8>; 4] {
        [self.ascii_2(), self.binary_2(), self.ascii_4(), self.binary_4()]
    }
}

/// Tetrahedron with a triangle on one of its faces.
pub(super) fn tetrahedron() -> Mesh {
    let nodes = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let block =
        |of, dimension, nodes: &[u64]| Block { of, dimension, entity: 1, elements: vec![nodes.to_vec()] };
    Mesh { nodes, blocks: vec![block(2, 2, &[3, 2, 1]), block(4, 3, &[1, 2, 3, 4])] }
}

/// Text of a file of version 2.2 with these elements, on the nodes 1 to 8 of a cube.
pub(super) fn cube(elements: &str) -> String {
    let nodes = "1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n";
    let count = elements.lines().count();
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n{nodes}$EndNodes\n$Elements\n{count}\n{elements}\n$EndElements\n"
    )
}
