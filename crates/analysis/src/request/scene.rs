//! The scene: which effects a simulation has. An effect that a scene does not name does not exist in the run.

use serde::{Deserialize, Serialize};

use crate::effects::list::effects;
use crate::request::omit::is_false;

macro_rules! scene {
    ($($(#[$($about:tt)*])* $effect:ident: $Asked:ty,)*) => {
        /// Effects of one simulation.
        #[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
        #[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
        #[serde(deny_unknown_fields)]
        pub struct Scene {
            $($(#[$($about)*])* pub $effect: $Asked,)*
        }
    };
}
effects!(scene);
