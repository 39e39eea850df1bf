//! Pictures of frequency responses: amplitude and phase, mean powers, the complex plane.

use super::{Transfer, transfers};
use crate::output::plot::canvas::LineStyle;
use crate::output::plot::colour::{Colour, PALETTE};
use crate::output::plot::extent;
use crate::output::plot::picture::{Panel, Picture, PictureAxis, PictureSeries};
use crate::results::response::{ComparedResponses, NamedResponse, PowerCurve, ResponseCurve, ResponseRecord};

/// Largest distance of a drawn amplitude from the median [dB]: undamped poles and zeros are unbounded.
const AROUND: f64 = 100.0;

/// Picture of amplitude, phase and mean powers over frequency.
pub(super) fn picture(found: &ResponseRecord) -> Option<Picture> {
    let mut panels = bode(&transfers(found))?;
    let power = |(curve, colour): (&PowerCurve, &Colour)| {
        let points = found.frequency_hz.iter().copied().zip(curve.mean_w.iter().copied());
        let points: Vec<_> = points.filter(|(_, power)| *power > 0.0).collect();
        PictureSeries::line(points, LineStyle::solid(*colour, 1.6)).named(curve.power.replace('_', " "))
    };
    let powers: Vec<_> = found.powers.iter().zip(PALETTE.iter().cycle()).map(power).collect();
    if !powers.is_empty() {
        let axis = PictureAxis::new("mean power", "W/input²", 5).logarithmic(true);
        panels.push(Panel::new((620.0, 200.0), panels[0].x.clone(), axis, powers));
    }
    let title = format!("{} · frequency response", found.case);
    Some(Picture::stacked(title, format!("to {}", found.input), panels))
}

/// Picture of the responses of several results.
pub fn overlay(all: &ComparedResponses) -> Option<Picture> {
    let curves: Vec<Transfer> = all.results.iter().flat_map(named).collect();
    let mut inputs: Vec<&str> = all.results.iter().map(|one| one.response.input.as_str()).collect();
    inputs.dedup();
    let title = "frequency responses".to_owned();
    Some(Picture::stacked(
        title,
        format!("to {}", inputs.join(", ")),
        bode(&curves)?,
    ))
}

/// Transfer functions of a result, named by its folder, and by the output if there are several.
fn named(one: &NamedResponse) -> Vec<Transfer<'_>> {
    let mut own = transfers(&one.response);
    let several = own.len() > 1;
    for transfer in &mut own {
        transfer.name = match several {
            true => format!("{}: {}", one.folder, transfer.name),
            false => one.folder.clone(),
        };
    }
    own
}

/// Panels of amplitude and phase.
fn bode(transfers: &[Transfer]) -> Option<Vec<Panel>> {
    let band = extent(transfers.iter().flat_map(|transfer| transfer.hz.iter().copied()))?;
    let x = || {
        PictureAxis::new("frequency", "Hz", 8)
            .between(band.0, band.1)
            .logarithmic(true)
    };
    let decibel = |transfer: &Transfer| -> Vec<f64> {
        let [real, imag, _] = transfer.parts;
        let parts = real.iter().zip(imag);
        parts.map(|(re, im)| 20.0 * re.hypot(*im).log10()).collect()
    };
    let (mut amplitudes, mut phases) = (vec![], vec![]);
    extent(transfers.iter().flat_map(decibel))?;
    for (transfer, colour) in transfers.iter().zip(PALETTE.iter().cycle()) {
        let stroke = LineStyle::solid(*colour, 1.6);
        let all = decibel(transfer);
        let mut sorted: Vec<f64> = all.iter().copied().filter(|amplitude| amplitude.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let Some(&middle) = sorted.get(sorted.len() / 2) else {
            continue;
        };
        let drawn = all
            .into_iter()
            .map(|amplitude| amplitude.clamp(middle - AROUND, middle + AROUND));
        let points = transfer.hz.iter().copied().zip(drawn);
        amplitudes.push(PictureSeries::line(points, stroke).named(&transfer.name));
        let [real, imag, _] = transfer.parts;
        let mut phase: Vec<(f64, f64)> = vec![];
        for (f, (re, im)) in transfer.hz.iter().zip(real.iter().zip(imag)) {
            let angle = im.atan2(*re).to_degrees();
            // a jump by a full turn is not part of the curve
            if phase.last().is_some_and(|(_, before)| (angle - before).abs() > 270.0) {
                phase.push((*f, f64::NAN));
            }
            phase.push((*f, angle));
        }
        phases.push(PictureSeries::line(phase, stroke));
    }
    let quarters = [-180.0, -90.0, 0.0, 90.0, 180.0].map(|angle| (angle, format!("{angle}").replace('-', "−")));
    let phase_axis = PictureAxis {
        labels: Some(quarters.to_vec()),
        ..PictureAxis::new("phase [°]", "", 5).between(-180.0, 180.0)
    };
    Some(vec![
        Panel::new((620.0, 250.0), x(), PictureAxis::new("amplitude", "dB", 6), amplitudes),
        Panel::new((620.0, 150.0), x(), phase_axis, phases),
    ])
}

/// Picture of each response in the complex plane, over its largest amplitude (Nyquist).
pub(super) fn nyquist(found: &ResponseRecord) -> Option<Picture> {
    let series = |(curve, colour): (&ResponseCurve, &Colour)| {
        let parts = || curve.real.iter().copied().zip(curve.imag.iter().copied());
        let largest = parts().map(|(re, im)| re.hypot(im)).fold(0.0, f64::max);
        let points = parts().map(|(re, im)| (re / largest, im / largest));
        let points: Vec<_> = points.filter(|(re, im)| re.is_finite() && im.is_finite()).collect();
        PictureSeries::line(points, LineStyle::solid(*colour, 1.6)).named(&curve.output)
    };
    let all: Vec<_> = found.curves().zip(PALETTE.iter().cycle()).map(series).collect();
    found.frequency_hz.get(1)?;
    let axis = |name: &str| PictureAxis::new(name, "", 5).between(-1.0, 1.0).with(&[0.0]);
    let panel = Panel::new((420.0, 420.0), axis("real part"), axis("imaginary part"), all);
    Some(Picture::stacked(
        format!("{} · responses in the complex plane", found.case),
        format!(
            "to {}, each over its largest amplitude; clockwise as the frequency increases",
            found.input
        ),
        [panel],
    ))
}
