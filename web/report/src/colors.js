// Colour maps: the nodes of src/io/picture/color_map.cpp, at even distances.

export const MAPS = {
  damage: ["#ded6c6", "#e9ca9a", "#f0a85a", "#e67a2e", "#cf4620", "#a81c18", "#6e0a14"],
  viridis: ["#440154", "#482878", "#3e4989", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725"],
  diverging: ["#3b4cc0", "#6282ea", "#8db0fe", "#b8d0f9", "#dddddd", "#f5c4ad", "#f49a7b", "#de604d", "#b40426"],
  batlow: ["#011959", "#103f60", "#1c5a62", "#3c6d56", "#687b3e", "#9d892b", "#d29343", "#f8a17b", "#fdb7bc", "#faccfa"],
  grey: ["#25272b", "#f2f2f0"],
};

export const CATEGORIES = [
  "#ded6c6", "#4a78a8", "#5c5f66", "#6aa56b", "#d98c3f", "#8d6bb1", "#46a3a8", "#c25b6e", "#9a8a3c", "#d0a2c4",
  "#481888", "#184818", "#c8c828", "#187818", "#781858", "#48d888", "#5848b8", "#8898e8", "#d8e888", "#284878", "#18c8e8",
  "#2888e8", "#288878", "#981838", "#883898", "#88d8e8", "#986848", "#d878c8", "#88b898", "#d8a818", "#785888", "#3868c8",
];

// Lines of charts: Okabe and Ito (2008), distinct for colour-blind readers.
export const LINES = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8b6f2a", "#7d7d7d"];

export const bytesOf = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));

/** `size` colours of a map as RGBA bytes. */
export function ramp(map, size = 256) {
  const nodes = MAPS[map].map(bytesOf), bytes = new Uint8Array(4 * size);
  for (let i = 0; i < size; ++i) {
    const place = (i / (size - 1)) * (nodes.length - 1), k = Math.min(Math.floor(place), nodes.length - 2);
    for (let c = 0; c < 3; ++c) bytes[4 * i + c] = Math.round(nodes[k][c] + (place - k) * (nodes[k + 1][c] - nodes[k][c]));
    bytes[4 * i + 3] = 255;
  }
  return bytes;
}

export function palette() {
  return new Uint8Array(CATEGORIES.flatMap((hex) => [...bytesOf(hex), 255]));
}

export const gradient = (map) => `linear-gradient(to right, ${MAPS[map].join(", ")})`;
