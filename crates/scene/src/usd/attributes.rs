//! What a prim says of itself: attributes at the first moment, over time, and as relationships.
use openusd::sdf::Value;
use openusd::usd;

use super::layers;
use crate::curve::{Animated, Curve, Interpolation};
use crate::error::shown;
use crate::gltf::fault::Fault;

/// A prim whose attributes are read.
pub struct Attributes<'a> {
    prim: &'a usd::Prim,
    /// Time codes a second.
    rate: f64,
}

impl<'a> Attributes<'a> {
    pub fn new(prim: &'a usd::Prim, rate: f64) -> Self {
        Self { prim, rate }
    }

    /// The prim's path.
    pub fn path(&self) -> String {
        self.prim.path().as_str().to_owned()
    }

    /// What is wrong with an attribute.
    pub fn fault(&self, name: &str, found: impl AsRef<str>, expected: impl Into<String>) -> Fault {
        Fault::new(shown(&format!("{}.{name}", self.prim.path().as_str())), found, expected)
    }

    /// What the crate could not do.
    fn failed(&self, name: &str, error: &dyn std::fmt::Display) -> Fault {
        self.fault(name, error.to_string(), "a value that can be read")
    }

    /// An attribute at its first moment; none if it has no value.
    pub fn get<T>(&self, name: &str, expected: &str, convert: fn(Value) -> Option<T>) -> Result<Option<T>, Fault> {
        let first = usd::TimeCode::EARLIEST;
        let value = self.prim.attribute(name).get_at::<Value>(first).map_err(|error| self.failed(name, &error))?;
        value.map_or(Ok(None), |value| self.converted(name, expected, value, convert).map(Some))
    }

    /// Where an asset is; none if none is named.
    pub fn asset(&self, name: &str) -> Result<Option<String>, Fault> {
        let attribute = self.prim.attribute(name);
        let value = attribute.get_at::<Value>(usd::TimeCode::EARLIEST).map_err(|error| self.failed(name, &error))?;
        let Some(value) = value else { return Ok(None) };
        let kind: &'static str = (&value).into();
        let asset = layers::asset(&attribute, value);
        let asset = asset.ok_or_else(|| self.fault(name, format!("a value of kind {kind}"), "an asset"))?;
        Ok(Some(asset).filter(|asset| !asset.is_empty()))
    }

    /// The values of an attribute over time, in seconds; one at time 0 if it has the same at all times, none without a value.
    pub fn keys<T>(&self, name: &str, expected: &str, convert: fn(Value) -> Option<T>) -> Result<Vec<(f64, T)>, Fault> {
        let attribute = self.prim.attribute(name);
        let query = attribute.query();
        let times = query.time_sample_times().map_err(|error| self.failed(name, &error))?;
        if times.is_empty() {
            return Ok(self.get(name, expected, convert)?.map(|value| (0.0, value)).into_iter().collect());
        }
        let mut keys = Vec::with_capacity(times.len());
        for time in times {
            let value = query.get_at::<Value>(usd::TimeCode::new(time)).map_err(|error| self.failed(name, &error))?;
            if let Some(value) = value {
                keys.push((time / self.rate, self.converted(name, expected, value, convert)?));
            }
        }
        Ok(keys)
    }

    /// An attribute over time; none without a value.
    pub fn curve<T: Animated + PartialEq>(
        &self,
        name: &str,
        (expected, interpolation): (&str, Interpolation),
        convert: fn(Value) -> Option<T>,
    ) -> Result<Option<Curve<T>>, Fault> {
        let keys = self.keys(name, expected, convert)?;
        let Some((_, first)) = keys.first() else { return Ok(None) };
        if keys.iter().all(|(_, value)| value == first) {
            return Ok(Some(Curve::constant(first.clone())));
        }
        let (times, values) = keys.into_iter().unzip();
        let curve = Curve::keyed(times, values, interpolation);
        curve.map(Some).map_err(|fault| self.fault(name, fault.found, fault.expected))
    }

    fn converted<T>(
        &self,
        name: &str,
        expected: &str,
        value: Value,
        convert: fn(Value) -> Option<T>,
    ) -> Result<T, Fault> {
        let kind: &'static str = (&value).into();
        convert(value).ok_or_else(|| self.fault(name, format!("a value of kind {kind}"), expected))
    }

    /// Metadata of an attribute; none if it has none.
    pub fn metadata<T>(&self, name: &str, key: &str, convert: fn(Value) -> Option<T>) -> Result<Option<T>, Fault> {
        let value = self.prim.attribute(name).get_metadata::<Value>(key);
        Ok(value.map_err(|error| self.failed(name, &error))?.and_then(convert))
    }

    /// The paths that a relationship names.
    pub fn targets(&self, name: &str) -> Result<Vec<String>, Fault> {
        let targets = self.prim.relationship(name).forwarded_targets();
        let targets = targets.map_err(|error| self.failed(name, &error))?;
        Ok(targets.iter().map(|path| path.as_str().to_owned()).collect())
    }
}
