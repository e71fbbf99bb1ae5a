// What the service says in its own words, which are English.
import { language } from "../messages/language";

const SERVICE_LANGUAGE = "en";

export function Served({ text }: { text: string }) {
  return language.value === SERVICE_LANGUAGE ? <>{text}</> : <span lang={SERVICE_LANGUAGE}>{text}</span>;
}
