// Dark or light: as the system has it, until somebody chooses.
export type Theme = "dark" | "light";

const KEY = "easypbr-theme";

function chosen(): Theme | null {
  try {
    const kept = localStorage.getItem(KEY);
    return kept === "dark" || kept === "light" ? kept : null;
  } catch {
    return null; // Storage is off.
  }
}

export function theme(): Theme {
  return document.documentElement.dataset.theme === "light" ? "light" : "dark";
}

export function setTheme(wanted: Theme): void {
  document.documentElement.dataset.theme = wanted;
  try {
    localStorage.setItem(KEY, wanted);
  } catch {
    // It lasts as long as the page then.
  }
}

export function startTheme(): void {
  const light = window.matchMedia("(prefers-color-scheme: light)");
  const follow = () => {
    if (!chosen()) document.documentElement.dataset.theme = light.matches ? "light" : "dark";
  };
  document.documentElement.dataset.theme = chosen() ?? "dark";
  follow();
  light.addEventListener("change", follow);
}
