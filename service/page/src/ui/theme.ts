// Light or dark: as the system has it, unless it is chosen.
import { computed, effect, signal } from "@preact/signals";
import { keep, kept } from "../kept";

const THEMES = ["light", "dark", "system"] as const;
export type ThemeChoice = (typeof THEMES)[number];

const PLACE = "maquette.theme";
const system = matchMedia("(prefers-color-scheme: dark)");

export function isTheme(text: unknown): text is ThemeChoice {
  return THEMES.some((each) => each === text);
}

const earlier = kept(PLACE);
const chosen = signal<ThemeChoice>(isTheme(earlier) ? earlier : "system");
const isSystemDark = signal(system.matches);
system.addEventListener("change", () => (isSystemDark.value = system.matches));

export const theme = computed(() => {
  if (chosen.value !== "system") return chosen.value;
  return isSystemDark.value ? "dark" : "light";
});

effect(() => {
  document.documentElement.dataset.theme = theme.value;
});

export function toggleTheme(): void {
  chosen.value = theme.value === "dark" ? "light" : "dark";
  keep(PLACE, chosen.value);
}
