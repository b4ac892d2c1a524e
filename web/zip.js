// Writes ZIP archives without compression (ZIP File Format Specification 6.3).

const UTF8_NAMES = 1 << 11; // general purpose bit flag
const VERSION = 20; // 2.0, needed to extract
const DATE = (1 << 5) | 1; // 1 January 1980

const TABLE = Uint32Array.from({ length: 256 }, (_, byte) => {
  let crc = byte;
  for (let bit = 0; bit < 8; bit += 1) crc = crc & 1 ? (crc >>> 1) ^ 0xedb88320 : crc >>> 1;
  return crc;
});

// Returns the CRC-32 of bytes (ISO 3309).
export function crc32(bytes) {
  let crc = -1;
  for (const byte of bytes) crc = (crc >>> 8) ^ TABLE[(crc ^ byte) & 255];
  return (crc ^ -1) >>> 0;
}

// Returns little-endian bytes of [bytes, value] pairs.
function record(...fields) {
  const view = new DataView(new ArrayBuffer(fields.reduce((sum, [size]) => sum + size, 0)));
  let at = 0;
  for (const [size, value] of fields) {
    if (size === 4) view.setUint32(at, value, true);
    else view.setUint16(at, value, true);
    at += size;
  }
  return view.buffer;
}

// Resolves to an archive of files [{path, file}], as a Blob. REQUIRES: fewer than 65,536 files, of less than
// 4 GiB in total.
export async function zipOf(files) {
  const parts = [];
  const directory = [];
  let offset = 0;
  for (const { path, file } of files) {
    const name = new TextEncoder().encode(path);
    const bytes = new Uint8Array(await file.arrayBuffer());
    // Fields that local headers and the directory share: flags, method, time, date, CRC-32, sizes, lengths of
    // the name and the extra field.
    const shared = [
      ...[VERSION, UTF8_NAMES, 0, 0, DATE].map((value) => [2, value]),
      ...[crc32(bytes), bytes.length, bytes.length].map((value) => [4, value]),
      [2, name.length],
      [2, 0],
    ];
    const local = record([4, 0x04034b50], ...shared);
    parts.push(local, name, bytes);
    // Lengths of the comment, disk, internal and external attributes, offset of the local header.
    const more = [
      [2, 0],
      [2, 0],
      [2, 0],
      [4, 0],
      [4, offset],
    ];
    directory.push(record([4, 0x02014b50], [2, VERSION], ...shared, ...more), name);
    offset += local.byteLength + name.length + bytes.length;
  }
  const size = directory.reduce((sum, part) => sum + part.byteLength, 0);
  const counts = [
    [2, 0],
    [2, 0],
    [2, files.length],
    [2, files.length],
  ];
  const end = record([4, 0x06054b50], ...counts, [4, size], [4, offset], [2, 0]);
  return new Blob([...parts, ...directory, end], { type: "application/zip" });
}
