//! Schema of an impeller request: that of the parameters, and the name of the preset.

use utoipa::openapi::{RefOr, Schema};
use utoipa::{PartialSchema, ToSchema};

use super::parameters::ImpellerParameters;
use super::preset::Preset;
use super::request::ImpellerRequest;

impl ToSchema for ImpellerRequest {
    fn schemas(schemas: &mut Vec<(String, RefOr<Schema>)>) {
        ImpellerParameters::schemas(schemas);
        schemas.push((Preset::name().into_owned(), Preset::schema()));
    }
}

impl PartialSchema for ImpellerRequest {
    /// Schema of [`ImpellerParameters`] with the preset's name, from which come all that are left out.
    fn schema() -> RefOr<Schema> {
        let mut schema = ImpellerParameters::schema();
        if let RefOr::T(Schema::Object(object)) = &mut schema {
            object.required.clear();
            object.properties.insert("preset".to_owned(), Preset::schema());
        }
        schema
    }
}
