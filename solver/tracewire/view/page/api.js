// What the page asks of its server: each request is JSON; a run comes back as a head and arrays.

const tab = crypto.randomUUID();

export class Refused extends Error {}

export async function ask(action, request = {}) {
  const answer = await fetch(action, {
    method: "POST",
    headers: {"Content-Type": "application/json"},
    body: JSON.stringify({...request, tab}),
  });
  if (!answer.ok) throw new Refused((await answer.text()).trim());
  const kind = answer.headers.get("Content-Type") || "";
  if (kind.startsWith("application/json")) return answer.json();
  return unpacked(await answer.arrayBuffer());
}

// the head of a run, with its arrays as `arrays`
function unpacked(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  let at = 4 + length;
  head.arrays = head.arrays.map(([count, bytes]) => {
    const array = new (bytes === 8 ? Float64Array : Float32Array)(buffer, at, count);
    at += 8 * Math.ceil(count * bytes / 8);
    return array;
  });
  return head;
}
