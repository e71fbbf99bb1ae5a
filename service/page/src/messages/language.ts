// Which language the page speaks: as the browser prefers, unless chosen here. Only its messages are loaded.
import { computed, effect, signal } from "@preact/signals";
import { keep, kept } from "../kept";
import type { Messages } from "./catalogue";

export const LANGUAGES = ["en", "de"] as const;
export type Language = (typeof LANGUAGES)[number];

interface Spoken {
  readonly language: Language;
  /** As the browser has it, with its region: it says how numbers and dates are written. */
  readonly locale: string;
  readonly messages: Messages;
}

const PLACE = "maquette.language";

const CATALOGUES: Readonly<Record<Language, () => Promise<Messages>>> = {
  en: () => import("./en").then(({ en }) => en),
  de: () => import("./de").then(({ de }) => de),
};

const spoken = signal<Spoken | null>(null);

/** Nothing is shown before a language is spoken. */
export const messages = computed(() => spoken.value!.messages);
export const language = computed(() => spoken.value!.language);
export const locale = computed(() => spoken.value!.locale);

export function speak(now: Spoken): void {
  spoken.value = now;
}

/** The first preferred language that the page speaks; English if it speaks none of them. */
export function preferred(tags: readonly string[]): Language {
  return tags.map(languageOf).find((known) => known !== null) ?? "en";
}

/** Speak the language chosen earlier, or else the preferred one; resolves once its messages are there. */
export async function startSpeaking(): Promise<void> {
  const chosen = kept(PLACE);
  await load(chosen === null ? preferred(navigator.languages) : preferred([chosen, ...navigator.languages]));
  effect(() => {
    document.documentElement.lang = language.value;
    document.querySelector('meta[name="description"]')?.setAttribute("content", messages.value.frame.description);
  });
}

export async function choose(chosen: Language): Promise<void> {
  await load(chosen);
  keep(PLACE, chosen);
}

/** Speak a language for as long as the page is open. */
export async function load(wanted: Language): Promise<void> {
  const found = await CATALOGUES[wanted]();
  speak({ language: wanted, locale: navigator.languages.find((tag) => languageOf(tag) === wanted) ?? wanted, messages: found });
}

/** The language of a tag such as `de-AT`; null for one that the page does not speak. */
export function languageOf(tag: string): Language | null {
  const primary = tag.toLowerCase().split("-")[0];
  return LANGUAGES.find((each) => each === primary) ?? null;
}
