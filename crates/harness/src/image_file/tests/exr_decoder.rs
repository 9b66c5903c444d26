//! A decoder of the EXR files that we write, after the description of the format alone: one part
//! of scan lines from the top, compressed by blocks of 16 rows. It shares nothing with the library
//! that writes them, and refuses everything else.

use flate2::read::ZlibDecoder;
use std::collections::BTreeMap;
use std::io::Read;

pub struct Decoded {
    pub width: u32,
    pub height: u32,
    /// The bits of red, green and blue of each pixel, row by row.
    pub bits: Vec<u32>,
}

struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    fn take(&mut self, count: usize) -> &'a [u8] {
        let (taken, rest) = self.0.split_at(count);
        self.0 = rest;
        taken
    }

    fn text(&mut self) -> &'a str {
        let length = self.0.iter().position(|&byte| byte == 0).expect("an end of the text");
        str::from_utf8(&self.take(length + 1)[..length]).expect("a name")
    }

    fn u32(&mut self) -> u32 {
        u32::from_le_bytes(self.take(4).try_into().expect("4 bytes"))
    }

    fn u64(&mut self) -> u64 {
        u64::from_le_bytes(self.take(8).try_into().expect("8 bytes"))
    }
}

pub fn decode(file: &[u8]) -> Decoded {
    let mut bytes = Bytes(file);
    // The magic number, version 2, and no flag: one part, no tiles, no long names.
    assert_eq!(bytes.take(8), b"\x76\x2f\x31\x01\x02\0\0\0");
    let mut attributes = BTreeMap::new();
    while bytes.0[0] != 0 {
        let (name, kind, size) = (bytes.text(), bytes.text(), bytes.u32());
        attributes.insert(name, (kind, bytes.take(size as usize)));
    }
    bytes.take(1);
    let attribute = |name: &str, kind: &str| {
        let (found, value) = attributes[name];
        assert_eq!(found, kind);
        Bytes(value)
    };
    assert!(!attributes.contains_key("tiles"));
    // ZIP in blocks of 16 rows, from the top.
    assert_eq!(attribute("compression", "compression").0, [3]);
    assert_eq!(attribute("lineOrder", "lineOrder").0, [0]);
    let mut window = attribute("dataWindow", "box2i");
    assert_eq!(window.0, attribute("displayWindow", "box2i").0);
    let [left, top, right, bottom] = [(); 4].map(|()| window.u32());
    assert_eq!((left, top), (0, 0));
    let mut channels = attribute("channels", "chlist");
    for name in ["B", "G", "R"] {
        assert_eq!(channels.text(), name);
        // Floats of 32 bits; a hint and reserved bytes; no subsampling.
        assert_eq!((channels.u32(), channels.take(4).len()), (2, 4));
        assert_eq!((channels.u32(), channels.u32()), (1, 1));
    }
    assert_eq!(channels.0, [0]);

    let (width, height) = (right as usize + 1, bottom as usize + 1);
    let offsets: Vec<u64> = (0..height.div_ceil(16)).map(|_| bytes.u64()).collect();
    let mut bits = vec![0; width * height * 3];
    for (block, offset) in offsets.into_iter().enumerate() {
        // In the order of the file, without a gap.
        assert_eq!(offset as usize, file.len() - bytes.0.len());
        let (y, size) = (bytes.u32() as usize, bytes.u32() as usize);
        assert_eq!(y, 16 * block);
        let rows = (height - y).min(16);
        let floats = decompress(bytes.take(size), rows * width * 12);
        for (index, float) in floats.chunks(4).enumerate() {
            let (row, channel, x) = (index / (3 * width), index / width % 3, index % width);
            let float = u32::from_le_bytes(float.try_into().expect("4 bytes"));
            bits[((y + row) * width + x) * 3 + 2 - channel] = float;
        }
    }
    assert!(bytes.0.is_empty());
    Decoded { width: width as u32, height: height as u32, bits }
}

/// Undoes the compression of a block: zlib, then differences, then the bytes' two halves.
fn decompress(block: &[u8], size: usize) -> Vec<u8> {
    if block.len() == size {
        return block.to_vec();
    }
    assert!(block.len() < size);
    let mut bytes = Vec::new();
    ZlibDecoder::new(block).read_to_end(&mut bytes).expect("zlib");
    assert_eq!(bytes.len(), size);
    for index in 1..size {
        bytes[index] = bytes[index].wrapping_add(bytes[index - 1]).wrapping_sub(128);
    }
    let (even, odd) = bytes.split_at(size.div_ceil(2));
    (0..size).map(|index| if index % 2 == 0 { even[index / 2] } else { odd[index / 2] }).collect()
}
