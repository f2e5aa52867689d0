// The fragment of the page's address: a secret that is taken out at once, a camera, settings.

export interface Link {
  token: string;
  camera: string;
  settings: Record<string, string>;
}

export function parseFragment(fragment: string): Link {
  const words = new URLSearchParams(fragment.replace(/^#/, ""));
  const settings: Record<string, string> = {};
  for (const pair of words.getAll("set")) {
    const equals = pair.indexOf("=");
    if (equals > 0) settings[pair.slice(0, equals)] = pair.slice(equals + 1);
  }
  return { token: words.get("token") ?? "", camera: words.get("camera") ?? "", settings };
}

export function formatFragment(link: Link): string {
  const words = new URLSearchParams();
  if (link.token) words.set("token", link.token);
  if (link.camera) words.set("camera", link.camera.trim());
  for (const [name, value] of Object.entries(link.settings)) words.append("set", `${name}=${value}`);
  return "#" + words.toString();
}

/** What the address says. The secret leaves the address bar; it stays with this tab's history entry for a reload. */
export function takeLink(): Link {
  const link = parseFragment(location.hash);
  const kept = (history.state as { token?: string } | null)?.token ?? "";
  if (!link.token) link.token = kept;
  keepToken(link.token);
  return link;
}

export function keepToken(token: string): void {
  history.replaceState({ token }, "", location.pathname + location.search);
}

/** A pasted link or the bare secret. */
export function tokenOf(text: string): string {
  const hash = text.indexOf("#");
  return hash >= 0 ? parseFragment(text.slice(hash)).token : text.trim();
}
