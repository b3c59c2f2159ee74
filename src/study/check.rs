use super::run::Request;
use crate::Result;
pub fn command(_: &Request) -> Result<String> {
    Ok(String::new())
}
