// The picture of the diagram. It comes from the server as SVG, and is put in as parsed nodes.

import {make, part} from "./page.js";

part("enlarge").addEventListener("click", () => {
  const large = document.body.classList.toggle("enlarged");
  part("enlarge").setAttribute("aria-pressed", String(large));
});

export function showDrawing(svg, jump) {
  const parsed = new DOMParser().parseFromString(svg, "image/svg+xml").documentElement;
  if (parsed.nodeName !== "svg") {
    part("drawing").replaceChildren(make("p", {textContent: "The picture cannot be shown."}));
    return;
  }
  const picture = document.importNode(parsed, true);
  picture.setAttribute("role", "img");
  picture.addEventListener("dblclick", (event) => {
    const block = event.target.closest("[data-block]");
    if (block) jump(block.getAttribute("data-block"));
  });
  const [width, height] = [picture.width.baseVal.value, picture.height.baseVal.value];
  picture.style.setProperty("--own", `${width}px`);
  picture.style.setProperty("--ratio", width / height);
  part("drawing").replaceChildren(picture);
}
