// The worker in which parts are planned: the program of the page once more, without a window.
import init, { plan, take_file } from "./studio.js";

let ready;

// The first message is the compiled program; then come model files, as {name, bytes}, and orders, as bytes.
onmessage = async ({ data }) => {
  try {
    if (!ready) {
      ready = init({ module_or_path: data });
    }
    await ready;
    if (data instanceof Uint8Array) {
      plan(data);
    } else if (data.name) {
      take_file(data.name, data.bytes);
    }
  } catch (error) {
    const memory = "a page has at most 4 GB of memory; the command `beadwright plan` may have more";
    postMessage(self.reason ?? (error instanceof WebAssembly.RuntimeError || error instanceof RangeError ? `${error} (${memory})` : String(error)));
  }
};
