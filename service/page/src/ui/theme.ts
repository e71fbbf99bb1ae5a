// Light or dark: as the system has it, unless chosen here.
import { effect, signal } from "@preact/signals";

type Theme = "light" | "dark";

const PLACE = "maquette.theme";
const system = matchMedia("(prefers-color-scheme: dark)");

function initial(): Theme {
  const kept = localStorage.getItem(PLACE);
  return kept === "light" || kept === "dark" ? kept : system.matches ? "dark" : "light";
}

export const theme = signal<Theme>(initial());

system.addEventListener("change", () => {
  if (localStorage.getItem(PLACE) === null) theme.value = system.matches ? "dark" : "light";
});

effect(() => {
  document.documentElement.dataset.theme = theme.value;
});

export function toggleTheme(): void {
  theme.value = theme.value === "dark" ? "light" : "dark";
  localStorage.setItem(PLACE, theme.value);
}
