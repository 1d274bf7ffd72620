//! The scene, its alternatives resolved.

use crate::effects::asked::Asked;
use crate::effects::casing::shape::Shape;
use crate::effects::friction::request::FrictionLaw;
use crate::effects::geometric_nonlinearity::request::Bending;
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
            /// Resolves the scene that is asked for. `refuse` is given violations of fields that together say too much or too little: clearances from
            /// such fields become 0, an elastic casing or mistuning is left away.
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
    /// Shape of the casing that the blades may touch; none without a casing or without contact.
    pub(crate) fn touched_shape(&self) -> Option<&Shape> {
        self.contact.as_ref()?;
        self.casing.as_ref().map(|casing| &casing.shape)
    }

    /// Whether blades stiffen as they bend, so that what linear bending leaves out is simulated.
    pub(crate) fn blades_stiffen(&self) -> bool {
        self.geometric_nonlinearity.as_ref().is_some_and(|of| of.include == Bending::Full)
    }

    /// Whether no tangent of the motion is known, so that it is always marched.
    pub(crate) fn is_marched(&self) -> bool {
        self.has_disc() || self.geometric_nonlinearity.is_some()
    }

    /// Whether tips may stick, and slide in any direction.
    pub(crate) fn has_disc(&self) -> bool {
        self.friction.as_ref().is_some_and(|friction| friction.law == FrictionLaw::Disc)
    }
}
