// The other language, in its own words.
import { LANGUAGES, choose, language } from "../messages/language";
import type { Language } from "../messages/language";

const NAMES: Readonly<Record<Language, string>> = { en: "English", de: "Deutsch" };

export function LanguageSwitch() {
  return (
    <>
      {LANGUAGES.filter((each) => each !== language.value).map((each) => (
        <button key={each} type="button" class="head-link" lang={each} onClick={() => void choose(each)}>
          {NAMES[each]}
        </button>
      ))}
    </>
  );
}
