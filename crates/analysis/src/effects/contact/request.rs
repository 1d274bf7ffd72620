//! Contact, as it is asked for.

use serde::{Deserialize, Serialize};

use crate::effects::asked::Plain;

/// Unilateral contact, exact complementarity at every step (Eqs 9, 10).
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(utoipa::ToSchema))]
#[serde(deny_unknown_fields)]
pub struct Contact {}

impl Plain for Option<Contact> {}
