//! Grammar of sweep requests as text: sound ones of every feature, with up to three of their parts replaced, doubled or taken out.

use proptest::prelude::*;
use proptest::sample::{Index, select};
use serde_json::{Value, json};

/// Texts that stand for a part that is replaced: wrong types, numbers at and beyond every limit, text that is no JSON.
const NASTY: [&str; 50] = [
    "null",
    "true",
    "\"\"",
    "\"auto\"",
    "\"0.3\"",
    "\"\\u0000\\ud83d\\ude00\"",
    "[]",
    "{}",
    "[[]]",
    "[0]",
    "[0.25,0.25,0.25]",
    "[1e-300,0,1e300]",
    "NaN",
    "Infinity",
    "-",
    "0",
    "-0",
    "-0.0",
    "1",
    "-1",
    "2",
    "3",
    "99",
    "100",
    "101",
    "500",
    "1000",
    "1001",
    "100000",
    "10000000",
    "4294967295",
    "4294967296",
    "18446744073709551616",
    "123456789012345678901234567890",
    "0.1",
    "0.049999999",
    "0.9999999999999999",
    "1.0000000000000002",
    "1e-4",
    "1e-12",
    "9e-31",
    "1e-300",
    "5e-324",
    "1e7",
    "1e12",
    "1e16",
    "1e31",
    "1e300",
    "1.7976931348623157e308",
    "1e999",
];

/// Change of a part of a request.
#[derive(Debug, Clone)]
enum Change {
    Replace(&'static str),
    /// Repeats a part: a field given twice, an element repeated.
    Double,
    Remove,
    /// Adds a further field or element, deeply nested.
    Add,
}

/// Bodies of requests, sound and changed.
pub(crate) fn request() -> impl Strategy<Value = String> {
    let change = prop_oneof![
        8 => select(&NASTY[..]).prop_map(Change::Replace),
        1 => Just(Change::Double),
        1 => Just(Change::Remove),
        1 => Just(Change::Add),
    ];
    (sound(), prop::collection::vec((any::<Index>(), change), 0..4))
        .prop_map(|(request, changes)| changed(request, &changes))
}

/// Sound requests that are mostly accepted and quickly run. Lengths are some tenths of a millimetre and speeds those of
/// the model, where contact is frequent; each also has extremes that are legal.
fn sound() -> impl Strategy<Value = Value> {
    let scene = (any::<bool>(), option(damping()), option(casing()), any::<bool>(), effects()).prop_map(
        |(stiffening, damping, casing, contact, effects)| {
            let mut scene = json!({"centrifugal_stiffening": stiffening});
            for (name, effect) in effects {
                scene[name] = effect;
            }
            if let Some(damping) = damping {
                scene["damping"] = damping;
            }
            if let Some(casing) = casing {
                scene["casing"] = casing;
                if contact {
                    scene["contact"] = json!({});
                }
            }
            scene
        },
    );
    (speeds(), scene, integration(), prop::collection::vec(sensor(), 0..3), 1..=30u32).prop_map(
        |(speeds, scene, integration, sensors, engine_order)| {
            json!({
                "model": "m", "modes_per_speed": 4, "speeds": speeds, "scene": scene, "integration": integration,
                "sensors": sensors, "max_engine_order": engine_order
            })
        },
    )
}

/// Values that are present three times in four.
fn option(of: impl Strategy<Value = Value>) -> impl Strategy<Value = Option<Value>> {
    prop::option::weighted(0.75, of)
}

fn speeds() -> impl Strategy<Value = Value> {
    let speed = prop_oneof![8 => 300.0..3000.0, 1 => select(vec![1e-12, 1e-3, 30.0, 2999.9999999, 3000.0])];
    let set = prop_oneof![
        prop::collection::vec(speed, 1..4).prop_map(|values| json!({"values": values, "unit": "rad_s"})),
        (1000.0..20000.0, 1..3u32).prop_map(
            |(from, count)| json!({"from": from, "to": from + f64::from(count - 1), "count": count, "unit": "rpm"})
        ),
    ];
    prop_oneof![4 => set.clone(), 1 => prop::collection::vec(set, 1..3).prop_map(Value::from)]
}

fn damping() -> impl Strategy<Value = Value> {
    let ratio = || select(vec![0.0, 1e-12, 0.001, 0.02, 0.3, 0.999_999]);
    (ratio(), prop::collection::vec(ratio(), 0..4))
        .prop_map(|(modal, family)| json!({"modal_ratio": modal, "family_ratios": family}))
}

/// Effects of a scene: none for half of the scenes, up to four for the others.
fn effects() -> impl Strategy<Value = Vec<(&'static str, Value)>> {
    let small = || select(vec![0.0, 1e-12, 1e-3, 0.05, 0.3, 1.0]);
    let stiff = || select(vec![1e-3, 20.0, 2e3, 2e5, 1e12]);
    let named = |name: &'static str, of: BoxedStrategy<Value>| of.prop_map(move |value| (name, value));
    let law = select(vec!["sliding", "disc"]);
    let friction = (small(), law).prop_map(|(mu, law)| json!({"coefficient": mu, "law": law}));
    let abradable = (stiff(), stiff(), stiff(), small(), 24..3000u32).prop_map(|(e, y, k, t, rods)| {
        json!({"modulus": e, "yield_stress": y, "hardening": k, "thickness": t, "rods_around": rods})
    });
    let ring = (stiff(), 0..10u32).prop_map(|(modulus, n_max)| {
        json!({"ring": {"radius": 70, "modulus": modulus, "density": 8e-9, "area": 40, "second_moment": 133,
                        "n_max": n_max}})
    });
    let modes = (0..5u32, stiff(), small()).prop_map(|(n, mass, zeta)| {
        json!({"modes": [{"nodal_diameter": n, "frequency_hz": 700, "modal_mass": 1e-6 * mass}],
               "damping_ratio": zeta})
    });
    let spread = (small(), any::<u64>()).prop_map(|(spread, seed)| json!({"spread": spread, "seed": seed}));
    let deviations =
        prop::collection::vec(-0.3..0.3, 5..7usize).prop_map(|values| json!({"deviations": values}));
    let order = (1..40u32, 0..3u32, small(), -9.0..9.0).prop_map(|(order, node, amplitude, phase)| {
        json!([{"order": order, "contact_nodes": [node], "component": "axial", "amplitude": amplitude,
                "phase_rad": phase}])
    });
    let orbit = (small(), -3.0..3.0)
        .prop_map(|(radius, ratio)| json!({"radius": radius, "whirl_ratio": ratio, "phase_rad": 0.3}));
    let wave = select(vec!["standing", "forward", "backward"]);
    let initial = (0..4u32, 1..6u32, small(), wave).prop_map(|(i, family, amplitude, wave)| {
        json!({"nodal_diameter": i, "family": family, "amplitude": amplitude, "wave": wave})
    });
    let effect = prop_oneof![
        named("coriolis", any::<bool>().prop_map(Value::from).boxed()),
        named("friction", friction.boxed()),
        named("abradable", abradable.boxed()),
        named("flexible_casing", prop_oneof![ring, modes].boxed()),
        named("mistuning", prop_oneof![spread, deviations].boxed()),
        named("engine_order_excitation", order.boxed()),
        named("orbit", orbit.boxed()),
        named("initial", initial.boxed()),
        named("symmetry", select(vec!["full", "exact", "probe"]).prop_map(Value::from).boxed()),
        named("probe", small().prop_map(|amplitude| json!({"amplitude": amplitude})).boxed()),
    ];
    prop_oneof![Just(Vec::new()), prop::collection::vec(effect, 1..4)]
}

fn casing() -> impl Strategy<Value = Value> {
    let length =
        || prop_oneof![4 => 0.1..0.5, 1 => select(vec![0.0, 1e-30, 1e-12, 1e-3, 5.0, 1e6, 1e15, 1e30])];
    let clearance = prop_oneof![
        (length(), length())
            .prop_map(|(leading, trailing)| json!({"leading": leading, "trailing": trailing})),
        prop::collection::vec(length(), 3).prop_map(|values| json!({"values": values})),
    ];
    let count = prop_oneof![4 => 1..8u32, 1 => Just(100)];
    let width = prop_oneof![4 => 0.05..1.0, 1 => select(vec![0.02, 7.0, 100.0])];
    let lobes = (count, length(), width, -1000.0..1000.0).prop_map(|(count, amplitude, width, phase)| {
        json!({"count": count, "amplitude": amplitude, "width_rad": width, "phase_rad": phase})
    });
    (clearance, option(lobes), shapes()).prop_map(|(clearance, lobes, shapes)| {
        let mut casing = json!({"clearance": clearance});
        if let Some(lobes) = lobes {
            casing["lobes"] = lobes;
        }
        casing.as_object_mut().expect("written above").extend(shapes);
        casing
    })
}

/// Shapes of a casing: at most one beside the lobes.
fn shapes() -> impl Strategy<Value = serde_json::Map<String, Value>> {
    let height = || prop_oneof![4 => -0.3..0.4, 1 => select(vec![0.0, 1e-40, 1e6])];
    let along = || option(prop::collection::vec(-1.0..1.0, 3).prop_map(|shares| json!(shares)));
    let lobe = (-10.0..10.0, height(), 0.02..3.0, along()).prop_map(|(angle, amplitude, width, along)| {
        json!({"angle_rad": angle, "amplitude": amplitude, "width_rad": width, "along_chord": along})
    });
    let wave = (1..101u32, height(), -10.0..10.0, along()).prop_map(|(order, amplitude, phase, along)| {
        json!({"order": order, "amplitude": amplitude, "phase_rad": phase, "along_chord": along})
    });
    let heights = prop::collection::vec(prop::collection::vec(-0.1..0.3, 12), 1..4);
    let measured = (heights, -7.0..7.0, 0.3..0.6, any::<bool>()).prop_map(|(heights, first, step, each)| {
        let angles: Vec<f64> = (0..12).map(|i| first + step * f64::from(i)).collect();
        let lines = heights.len().max(2) - 1;
        let chord: Vec<f64> = (0..heights.len()).map(|line| line as f64 / lines as f64).collect();
        json!({"angles_rad": angles, "chord": if each { Value::Null } else { json!(chord) }, "heights": heights})
    });
    let tilt = (-2e-3..2e-3, -10.0..10.0, -50.0..50.0).prop_map(
        |(angle, towards, about)| json!({"angle_rad": angle, "towards_rad": towards, "about_z": about}),
    );
    let of = |name: &'static str, value: Value| [(name.to_owned(), value)].into_iter().collect();
    prop_oneof![
        4 => Just(serde_json::Map::new()),
        1 => prop::collection::vec(lobe, 0..4).prop_map(move |lobes| of("single_lobes", json!(lobes))),
        1 => prop::collection::vec(wave, 0..4).prop_map(move |waves| of("waves", json!(waves))),
        1 => measured.prop_map(move |measured| of("measured", measured)),
        1 => tilt.prop_map(move |tilt| of("tilt", tilt)),
    ]
}

fn integration() -> impl Strategy<Value = Value> {
    let steps = prop_oneof![3 => (61..2000u32).prop_map(Value::from), 1 => Just(json!("auto"))];
    let scheme = select(vec!["auto", "central_differences", "exact_modal", "massless_boundary"]);
    let kept = prop_oneof![2 => (1..30u32).prop_map(Value::from), 1 => Just(json!("auto"))];
    let steady = select(vec!["march", "march", "periodic", "auto"]);
    let ramp = select(vec![0.0, 0.05, 0.5, 1.0]);
    (1..4u32, 0..2u32, ramp, steps, scheme, kept, steady, by_itself()).prop_map(
        |(window, before, ramp, steps, scheme, kept, steady, by_itself)| {
            let mut integration = json!({
                "window_revolutions": window, "revolutions": window + before.max(ramp as u32 + 1),
                "ramp_revolutions": ramp, "steps_per_revolution": steps, "scheme": scheme, "steady": steady
            });
            if scheme == "massless_boundary" {
                integration["kept_modes"] = kept;
            }
            for (name, value) in by_itself {
                integration[name] = value;
            }
            integration
        },
    )
}

/// Settings of the integration for a march that ends by itself, for half of the requests.
fn by_itself() -> impl Strategy<Value = Vec<(&'static str, Value)>> {
    let most = prop_oneof![4 => 12..40u32, 1 => select(vec![1, 5, 100])];
    let settled_to = select(vec![1e-12, 1e-6, 1e-3, 1e-2]);
    let ends = (most, settled_to).prop_map(|(most, settled_to)| {
        let auto = ("revolutions", json!("auto"));
        vec![auto, ("most_revolutions", json!(most)), ("settled_to", json!(settled_to))]
    });
    prop_oneof![2 => Just(Vec::new()), 2 => ends]
}

fn sensor() -> impl Strategy<Value = Value> {
    let component = select(vec!["radial", "tangential", "axial", "normal"]);
    (0..3u32, 0..6u32, component).prop_map(
        |(node, sector, component)| json!({"contact_node": node, "sector": sector, "component": component}),
    )
}

/// Text of `request` with `changes` made to parts drawn from all of it.
fn changed(mut request: Value, changes: &[(Index, Change)]) -> String {
    // Text that a `Value` cannot hold stands behind a mark until the end.
    let mut marked = Vec::new();
    for (place, change) in changes {
        let mut pointers = Vec::new();
        collect(&request, String::new(), &mut pointers);
        if pointers.is_empty() {
            break;
        }
        let pointer = place.get(&pointers);
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        let mut mark = |part: &mut Value, text: String| {
            *part = Value::from(format!("mark {}", marked.len()));
            marked.push((part.to_string(), text));
        };
        let part = request.pointer_mut(pointer).unwrap();
        match change {
            Change::Replace(text) => mark(part, (*text).to_owned()),
            Change::Double => {
                let again = if key.parse::<usize>().is_ok() { String::new() } else { format!("\"{key}\":") };
                let text = format!("{part},{again}{part}");
                mark(part, text);
            }
            Change::Remove => match request.pointer_mut(parent).unwrap() {
                Value::Object(fields) => _ = fields.remove(key),
                Value::Array(elements) => _ = elements.remove(key.parse().unwrap()),
                _ => unreachable!("a parent has children"),
            },
            Change::Add => {
                let text = format!("{}{}", "[".repeat(200), "]".repeat(200));
                match part {
                    Value::Object(fields) => mark(fields.entry("further").or_insert(Value::Null), text),
                    other => mark(other, text),
                }
            }
        }
    }
    let mut text = request.to_string();
    for (mark, with) in marked.iter().rev() {
        text = text.replace(mark, with);
    }
    text
}

/// Collects pointers to all parts below the root.
fn collect(value: &Value, at: String, pointers: &mut Vec<String>) {
    let children: Vec<(String, &Value)> = match value {
        Value::Object(fields) => fields.iter().map(|(key, child)| (key.clone(), child)).collect(),
        Value::Array(elements) => {
            elements.iter().enumerate().map(|(index, child)| (index.to_string(), child)).collect()
        }
        _ => return,
    };
    for (key, child) in children {
        let pointer = format!("{at}/{key}");
        pointers.push(pointer.clone());
        collect(child, pointer, pointers);
    }
}
