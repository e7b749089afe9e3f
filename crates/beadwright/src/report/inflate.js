// Base64 and deflate, as the library writes them.

const bytesOf = text => Uint8Array.from(atob(text), c => c.charCodeAt(0));

async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

