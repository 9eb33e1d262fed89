//! Line charts as SVG.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::Result;
use planish_film::{check_text_output, write_text};

/// Size of a panel and of its margins, in pixels.
const PANEL: [f64; 2] = [640.0, 170.0];
const MARGIN: [f64; 2] = [70.0, 34.0];
/// Colours of series; they can be told apart in grey, too.
const COLOURS: [&str; 4] = ["#c2571a", "#1f5fa8", "#3c7d3c", "#777777"];

/// A line.
pub struct Series {
    pub name: String,
    /// One a frame.
    pub values: Vec<f64>,
}

/// Panels below each other, with the same frames along x.
pub struct Chart {
    pub title: String,
    /// What y is, and the lines.
    pub panels: Vec<(String, Vec<Series>)>,
}

impl Chart {
    /// Writes it, whole or not at all.
    pub fn write(&self, path: &Path) -> Result<()> {
        check_text_output(path)?;
        Ok(write_text(&self.to_svg(), path)?)
    }

    fn to_svg(&self) -> String {
        let width = PANEL[0] + 2.0 * MARGIN[0];
        let height = self.panels.len() as f64 * (PANEL[1] + MARGIN[1]) + 2.0 * MARGIN[1];
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
             font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>\n\
             <text x=\"{}\" y=\"20\" font-size=\"15\">{}</text>\n",
            MARGIN[0], self.title
        );
        for (place, (name, series)) in self.panels.iter().enumerate() {
            let top = MARGIN[1] + place as f64 * (PANEL[1] + MARGIN[1]);
            svg += &panel(top, name, series);
        }
        svg + "</svg>\n"
    }
}

fn panel(top: f64, name: &str, series: &[Series]) -> String {
    let largest = series.iter().flat_map(|line| &line.values).fold(0.0, |a: f64, &b| a.max(b));
    let top_value = rounded_up(largest);
    let [width, height] = PANEL;
    let x = |place: usize, count: usize| MARGIN[0] + width * place as f64 / count.saturating_sub(1).max(1) as f64;
    let y = |value: f64| top + height - height * value / top_value;
    let mut svg = String::new();
    for part in 0..=4 {
        let value = top_value * f64::from(part) / 4.0;
        // Writing to a string cannot fail.
        let _ = writeln!(
            svg,
            "<path d=\"M{:.1} {:.1}h{width}\" stroke=\"#dddddd\"/><text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{value}</text>",
            MARGIN[0],
            y(value),
            MARGIN[0] - 6.0,
            y(value) + 4.0
        );
    }
    let _ =
        writeln!(svg, "<text x=\"{:.1}\" y=\"{:.1}\" font-weight=\"bold\">{name}</text>", MARGIN[0] + 6.0, top + 12.0);
    for (place, (line, colour)) in series.iter().zip(COLOURS).enumerate() {
        let points: Vec<String> = line
            .values
            .iter()
            .enumerate()
            .map(|(frame, &value)| format!("{:.1},{:.1}", x(frame, line.values.len()), y(value)))
            .collect();
        let _ = writeln!(
            svg,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.6\"/>\n\
             <text x=\"{:.1}\" y=\"{:.1}\" fill=\"{colour}\">{}</text>",
            points.join(" "),
            MARGIN[0] + width + 8.0,
            top + 14.0 + 16.0 * place as f64,
            line.name
        );
    }
    svg
}

/// The next number of one digit and zeros, or 1.
fn rounded_up(value: f64) -> f64 {
    if value <= 0.0 {
        return 1.0;
    }
    let unit = 10.0_f64.powf(value.log10().floor());
    (value / unit).ceil() * unit
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_end_at_round_numbers() {
        assert_eq!([0.0, 0.5, 1.0, 17.0, 900.1].map(rounded_up), [1.0, 0.5, 1.0, 20.0, 1000.0]);
    }

    #[test]
    fn every_frame_of_every_line_is_drawn() {
        let series = |name: &str| Series { name: name.to_owned(), values: vec![1.0, 5.0, 3.0] };
        let chart =
            Chart { title: "a".to_owned(), panels: vec![("b".to_owned(), vec![series("fas"), series("dfas")])] };
        let svg = chart.to_svg();
        assert_eq!(svg.matches("<polyline").count(), 2);
        let line = svg.split("points=\"").nth(1).and_then(|rest| rest.split('"').next()).unwrap();
        assert_eq!(line.split(' ').count(), 3);
    }
}
