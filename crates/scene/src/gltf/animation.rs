//! Animations to curves, by node (glTF 2.0, section 3.11).
use std::collections::HashMap;

use ::gltf::json::animation::{self, Animation, Property};
use ::gltf::json::validation::Checked;
use glam::{DQuat, DVec3};

use super::data::Data;
use super::fault::{Fault, at};
use crate::curve::{Animated, Curve, Interpolation};
use crate::error::name_list;

/// What an animation changes of a node.
#[derive(Default)]
pub struct Channels {
    pub translation: Option<Curve<DVec3>>,
    pub rotation: Option<Curve<DQuat>>,
    pub scale: Option<Curve<DVec3>>,
    /// All weights at every key, one key after another: how many each has the mesh says.
    pub weights: Option<Keys>,
}

/// Keys whose values are not yet divided.
pub struct Keys {
    times: Vec<f64>,
    values: Vec<f64>,
    interpolation: Interpolation,
    place: String,
}

/// One animation of a file.
#[derive(Default)]
pub struct Clip {
    /// By the file's nodes.
    pub channels: HashMap<usize, Channels>,
    /// First and last key of all, in seconds.
    pub time_range: Option<[f64; 2]>,
}

/// The names of all animations.
pub fn names(animations: &[Animation]) -> Vec<String> {
    let name = |(index, animation): (usize, &Animation)| {
        animation.name.clone().filter(|name| !name.is_empty()).unwrap_or_else(|| format!("animation {index}"))
    };
    animations.iter().enumerate().map(name).collect()
}

/// Reads the animation of that name; without a name the first, if there is one.
pub fn read(data: &Data, wanted: Option<&str>) -> Result<Clip, Fault> {
    let names = names(&data.root.animations);
    let index = match wanted {
        None => 0,
        Some(wanted) => names.iter().position(|name| name == wanted).ok_or_else(|| {
            let expected = name_list(names.iter().map(String::as_str), "animations");
            Fault::new("animations", format!("the name {wanted:?}"), crate::error::shown(&expected))
        })?,
    };
    let Some(animation) = data.root.animations.get(index) else { return Ok(Clip::default()) };
    let mut clip = Clip::default();
    for (number, channel) in animation.channels.iter().enumerate() {
        let place = format!("animations[{index}].channels[{number}]");
        clip.add(data, animation, channel, &place)?;
    }
    Ok(clip)
}

impl Clip {
    fn add(
        &mut self,
        data: &Data,
        animation: &Animation,
        channel: &animation::Channel,
        place: &str,
    ) -> Result<(), Fault> {
        let sampler = at(&animation.samplers, channel.sampler.value(), "samplers", || place.to_owned())?;
        let node = channel.target.node.value();
        at(&data.root.nodes, node, "nodes", || place.to_owned())?;
        let (Checked::Valid(property), Checked::Valid(interpolation)) = (channel.target.path, sampler.interpolation)
        else {
            return Err(Fault::new(place, "an unknown path or interpolation", "those of glTF 2.0"));
        };
        let times = data.floats::<1>(sampler.input, place)?;
        let times: Vec<f64> = times.into_iter().map(|[time]| f64::from(time)).collect();
        if let (Some(&first), Some(&last)) = (times.first(), times.last()) {
            let [start, end] = self.time_range.unwrap_or([first, last]);
            self.time_range = Some([start.min(first), end.max(last)]);
        }
        let interpolation = match interpolation {
            animation::Interpolation::Step => Interpolation::Step,
            animation::Interpolation::Linear => Interpolation::Linear,
            animation::Interpolation::CubicSpline => Interpolation::Cubic,
        };
        let keys = (times, interpolation, place);
        let channels = self.channels.entry(node).or_default();
        let is_second = match property {
            Property::Translation => channels.translation.replace(vectors(data, sampler, keys)?).is_some(),
            Property::Scale => channels.scale.replace(vectors(data, sampler, keys)?).is_some(),
            Property::Rotation => {
                let values = data.floats::<4>(sampler.output, place)?;
                let values = values.into_iter().map(|value| DQuat::from_array(value.map(f64::from))).collect();
                channels.rotation.replace(curve(keys, values)?).is_some()
            }
            Property::MorphTargetWeights => {
                let values = data.floats::<1>(sampler.output, place)?;
                let values = values.into_iter().map(|[weight]| f64::from(weight)).collect();
                let keys = Keys { times: keys.0, values, interpolation, place: place.to_owned() };
                channels.weights.replace(keys).is_some()
            }
        };
        if is_second {
            return Err(Fault::new(place, format!("node {node} animated twice in one way"), "one channel each"));
        }
        Ok(())
    }
}

type KeyTimes<'a> = (Vec<f64>, Interpolation, &'a str);

fn vectors(data: &Data, sampler: &animation::Sampler, keys: KeyTimes) -> Result<Curve<DVec3>, Fault> {
    let values = data.floats::<3>(sampler.output, keys.2)?;
    curve(keys, values.into_iter().map(|value| DVec3::from(value.map(f64::from))).collect())
}

fn curve<T: Animated>((times, interpolation, place): KeyTimes, values: Vec<T>) -> Result<Curve<T>, Fault> {
    Curve::keyed(times, values, interpolation).map_err(|fault| Fault::new(place, fault.found, fault.expected))
}

impl Keys {
    /// The weights of so many morph targets.
    pub fn curve(&self, target_count: usize) -> Result<Curve<Vec<f64>>, Fault> {
        let per_key = if self.interpolation == Interpolation::Cubic { 3 } else { 1 };
        if self.values.len() != self.times.len() * per_key * target_count {
            let found = format!("{} weights at {} keys", self.values.len(), self.times.len());
            let expected = format!("{} a key for {target_count} morph targets", per_key * target_count);
            return Err(Fault::new(&self.place, found, expected));
        }
        let values = match target_count {
            0 => vec![Vec::new(); self.times.len() * per_key],
            _ => self.values.chunks(target_count).map(<[f64]>::to_vec).collect(),
        };
        curve((self.times.clone(), self.interpolation, &self.place), values)
    }
}
