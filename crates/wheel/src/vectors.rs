//! Name of the vectors that the loops run on.

/// Kind of the vectors that the inner loops run on, chosen as the program runs ([`rubmap_numerics::vectors`]): `Scalar`, `V3` (AVX2) or `V4` (AVX-512), or the library's
/// name for those of other processors. Another kind adds up in another order, and may round otherwise.
pub fn vectors() -> String {
    // The name of the variant; what it holds is a proof that the processor has them.
    let kind = format!("{:?}", rubmap_numerics::vectors::arch());
    kind.chars().take_while(char::is_ascii_alphanumeric).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn kinds_have_the_names_of_the_digests() {
        let kind = super::vectors();
        let known = ["Scalar", "V3", "V4"].contains(&kind.as_str());
        assert!(known || cfg!(not(target_arch = "x86_64")), "{kind}");
    }
}
