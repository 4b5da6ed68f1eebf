// Small helpers: parts of the page, elements, and numbers as text. Texts go in as text only.

export const part = (id) => document.getElementById(id);

export function make(tag, given = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(given)) {
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (name === "for") made.setAttribute(name, value);
    else made[name] = value;
  }
  made.append(...children);
  return made;
}

// six digits, without the commas of a locale
export function shown(value, digits = 6) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "";
  return String(+value.toPrecision(digits));
}

// hand a text to the user as a file
export function download(name, text, type) {
  const address = URL.createObjectURL(new Blob([text], {type}));
  make("a", {href: address, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}
