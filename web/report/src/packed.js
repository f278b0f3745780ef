// Blobs of the page and what is in them: the reader of src/report/packed_bytes.hpp.

/** Bytes of a blob: base 64 of a zlib stream. */
export async function blobBytes(number) {
  const element = document.getElementById(`blob-${number}`);
  const text = atob(element.textContent);
  const packed = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) packed[i] = text.charCodeAt(i);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

export async function blobText(number) {
  return new TextDecoder().decode(await blobBytes(number));
}

/** Reads numbers whose bytes lie in planes. */
export class Planes {
  constructor(bytes) {
    this.bytes = bytes;
    this.place = 0;
  }
  /** `count` whole numbers of `width` bytes. */
  numbers(count, width) {
    const numbers = new Uint32Array(count);
    for (let plane = 0; plane < width; ++plane) {
      const shift = 8 * plane;
      for (let i = 0; i < count; ++i) numbers[i] |= this.bytes[this.place + i] << shift;
      this.place += count;
    }
    return numbers;
  }
}

export const unzigzag = (folded) => (folded >>> 1) ^ -(folded & 1);

/** Columns of a table as {name, unit, values}. */
export async function readTable(table) {
  if (!table) return {columns: [], rows: 0};
  const planes = new Planes(await blobBytes(table.blob));
  const columns = table.columns.map(({name, unit}) => {
    const bits = planes.numbers(table.rows, 4);
    return {name, unit, values: new Float32Array(bits.buffer)};
  });
  return {columns, rows: table.rows, column: (name) => columns.find((c) => c.name === name)};
}
