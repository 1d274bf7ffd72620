//! The scene with its alternatives told apart.

use crate::effects::asked::Asked;
use crate::effects::casing::shape::Shape;
use crate::effects::friction::request::FrictionLaw;
use crate::effects::list::effects;
use crate::error::Violation;
use crate::request;

macro_rules! scene {
    ($($(#[$($about:tt)*])* $effect:ident: $Asked:ty,)*) => {
        /// Effects of one simulation; see [`request::Scene`].
        #[derive(Debug, Clone, Default, PartialEq)]
        pub struct Scene {
            $(pub(crate) $effect: <$Asked as Asked>::Resolved,)*
        }

        impl Scene {
            /// The scene that is asked for. `refuse` hears of fields that together say too much or too little: a clearance that
            /// they would give is none then, an elastic casing or mistuning left away.
            pub(crate) fn of(asked: request::Scene, refuse: &mut dyn FnMut(Violation)) -> Self {
                Self { $($effect: asked.$effect.resolve(refuse),)* }
            }
        }

        impl From<Scene> for request::Scene {
            fn from(scene: Scene) -> Self {
                Self { $($effect: Asked::of(scene.$effect),)* }
            }
        }
    };
}
effects!(scene);

impl Scene {
    /// What of the casing passes the blades and may be touched.
    pub(crate) fn touched_shape(&self) -> Option<&Shape> {
        self.contact.as_ref()?;
        self.casing.as_ref().map(|casing| &casing.shape)
    }

    /// Whether tips may stick, and slide in any direction.
    pub(crate) fn has_disc(&self) -> bool {
        self.friction.as_ref().is_some_and(|friction| friction.law == FrictionLaw::Disc)
    }
}
