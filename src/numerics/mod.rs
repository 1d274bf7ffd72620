//! Linear algebra and transforms; nothing here has heard of a rotor.
