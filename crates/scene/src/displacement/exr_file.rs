//! OpenEXR to texels: the first part, flat, half, float or uint.
use std::io::Seek;

use exr::meta::MetaData;
use exr::meta::header::Header;
use exr::prelude::{FlatSamples, ReadChannels, ReadLayers};

use super::DisplacementKind;
use super::limits::check_claim;
use super::raster::{Raster, Source, undecodable, without_vectors};
use super::texel::TexelFold;
use crate::error::{Fault, shown};

pub fn decode(mut source: Source, fold: &mut TexelFold) -> Result<Raster, Fault> {
    let undecodable = |error: exr::error::Error| undecodable("OpenEXR", error);
    let metadata = MetaData::read_from_buffered(&mut source.reader, false).map_err(undecodable)?;
    let header = metadata.headers.first().ok_or_else(|| Fault::whole("no part", "an OpenEXR image"))?;
    check_header(header, source.bytes)?;
    let wanted = channel_indices(header, fold.kind)?;
    source.reader.rewind().map_err(|error| undecodable(error.into()))?;
    // One thread: a decoder's panic then stays in the one that guards against it.
    let reader = exr::prelude::read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
    let image = reader.all_attributes().non_parallel().from_buffered(source.reader).map_err(undecodable)?;
    let (size, channels) = (image.layer_data.size, image.layer_data.channel_data.list);
    let [width, height] = [size.width() as u32, size.height() as u32];
    let channels: Option<Vec<&FlatSamples>> =
        wanted.iter().map(|&index| channels.get(index).map(|channel| &channel.sample_data)).collect();
    let channels = channels
        .filter(|channels| size == header.layer_size && channels.iter().all(|samples| samples.len() == size.area()))
        .ok_or_else(|| Fault::whole("samples that are not those of the first part", "an intact OpenEXR image"))?;
    let mut values = Vec::with_capacity(size.area() * channels.len());
    let mut texel = [0.0; 3];
    for index in 0..size.area() {
        for (value, samples) in texel.iter_mut().zip(&channels) {
            *value = raw_value(samples, index);
        }
        fold.push(&texel[..channels.len()], &mut values);
    }
    Ok(Raster { width, height, values })
}

fn raw_value(samples: &FlatSamples, index: usize) -> f64 {
    match samples {
        FlatSamples::F16(samples) => samples[index].to_f64(),
        FlatSamples::F32(samples) => f64::from(samples[index]),
        FlatSamples::U32(samples) => f64::from(samples[index]) / f64::from(u32::MAX),
    }
}

fn check_header(header: &Header, file_bytes: u64) -> Result<(), Fault> {
    if header.deep {
        return Err(Fault::whole("deep data", "a flat OpenEXR image"));
    }
    if header.channels.list.iter().any(|channel| channel.sampling.width() != 1 || channel.sampling.height() != 1) {
        return Err(Fault::whole("subsampled channels", "channels with a sample in every texel"));
    }
    let [width, height] = [header.layer_size.width() as u64, header.layer_size.height() as u64];
    check_claim(width, height, header.channels.bytes_per_pixel as u64, file_bytes)
}

/// In the header's list: Y, R or the only channel for a scalar, R G B for a vector.
fn channel_indices(header: &Header, kind: DisplacementKind) -> Result<Vec<usize>, Fault> {
    let list = &header.channels.list;
    let find = |name: &str| list.iter().position(|channel| channel.name.eq(name));
    let names = || {
        let names: Vec<String> = list.iter().take(10).map(|channel| channel.name.to_string()).collect();
        format!("the channels {}", shown(&names.join(", ")))
    };
    match kind {
        DisplacementKind::Vector => {
            let channels: Option<Vec<usize>> = ["R", "G", "B"].into_iter().map(find).collect();
            channels.ok_or_else(|| without_vectors(&names()))
        }
        DisplacementKind::Scalar => {
            let only = (list.len() == 1).then_some(0);
            let channel = find("Y").or_else(|| find("R")).or(only);
            channel
                .map(|channel| vec![channel])
                .ok_or_else(|| Fault::whole(names(), "channel Y or R, or one channel alone, for a scalar displacement"))
        }
    }
}
