// Runs the module named on the command line and exits as it says: node run.mjs MODULE.wasm

import { readFileSync } from "node:fs";

const decoder = new TextDecoder();
const print = (address, length) => {
  const text = new Uint8Array(instance.exports.memory.buffer, address, length);
  process.stdout.write(decoder.decode(text, { stream: true }));
};
const { instance } = await WebAssembly.instantiate(readFileSync(process.argv[2]), { env: { print } });
process.exitCode = instance.exports.accept();
