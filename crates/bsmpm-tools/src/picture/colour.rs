//! Colours of all pictures.

/// Red, green, blue.
pub(crate) type Rgb = [u8; 3];

pub(crate) const WHITE: Rgb = [255, 255, 255];
/// Text and axes.
pub(crate) const INK: Rgb = [30, 30, 30];
/// What should stand back: the outline of the grid.
pub(crate) const OUTLINE: Rgb = [140, 140, 140];
/// Lines across the picture at each tick.
pub(crate) const RULE: Rgb = [226, 226, 226];

/// Seven colours that also the colour-blind tell apart (Okabe and Ito, 2008), without yellow, which is lost on white.
const LINES: [Rgb; 7] = [
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [230, 159, 0],
    [86, 180, 233],
    [60, 60, 60],
];

/// Viridis (van der Walt and Smith, 2015; CC0): equal steps of the number are equal steps to the eye, in grey too.
const VIRIDIS: [Rgb; 33] = [
    [68, 1, 84],
    [71, 13, 96],
    [72, 24, 106],
    [72, 35, 116],
    [71, 45, 123],
    [69, 54, 129],
    [66, 64, 134],
    [63, 73, 137],
    [59, 82, 139],
    [55, 90, 141],
    [51, 99, 141],
    [47, 106, 142],
    [44, 114, 142],
    [41, 122, 142],
    [38, 129, 142],
    [35, 137, 142],
    [33, 144, 140],
    [31, 152, 139],
    [31, 159, 136],
    [33, 166, 133],
    [40, 174, 128],
    [49, 181, 123],
    [62, 188, 116],
    [76, 194, 108],
    [93, 201, 99],
    [110, 206, 88],
    [130, 211, 76],
    [150, 216, 63],
    [171, 220, 50],
    [192, 223, 36],
    [213, 226, 26],
    [234, 229, 26],
    [253, 231, 37],
];

/// The colour of the line `index` out of `count`: distinct ones, or shades from first to last if they are too many.
pub(crate) fn line(index: usize, count: usize) -> Rgb {
    if count <= LINES.len() {
        LINES[index % LINES.len()]
    } else {
        map(0.9 * index as f64 / (count - 1) as f64)
    }
}

/// The colour of a share between 0 and 1 of the range; what lies outside takes the colour of the end.
pub(crate) fn map(share: f64) -> Rgb {
    let place = share.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    let below = (place as usize).min(VIRIDIS.len() - 2);
    let rest = place - below as f64;
    [0, 1, 2].map(|channel| {
        let low = f64::from(VIRIDIS[below][channel]);
        let high = f64::from(VIRIDIS[below + 1][channel]);
        (low + rest * (high - low)).round() as u8
    })
}
