// What of a product can be looked at: its pictures, and its body to be turned.
import type { Derivation } from "../api/types";
import { messages } from "../messages";
import { kindLabel, kindOf } from "./kinds";
import type { Shows } from "./kinds/kind";

export interface View {
  readonly file: string;
  readonly label: string;
  /** Null of a body that is turned. */
  readonly picture: Shows | null;
}

/** What is seen first stands first; nothing of a kind that this page does not know. */
export function viewsOf({ kind: name, links }: Derivation): readonly View[] {
  const kind = kindOf(name);
  if (!kind) return [];
  const files = Object.keys(links.artifacts ?? {});
  const numbered = files.sort().map((file) => kind.pictureOf?.(file) ?? null);
  const pictures = [...kind.pictures, ...numbered.filter((shows) => shows !== null)].map((picture) => ({
    file: picture.file,
    label: picture.label?.() ?? kindLabel(name),
    picture,
  }));
  const { turns } = kind;
  if (!turns || !files.includes(turns.file)) return pictures;
  const turned = { file: turns.file, label: messages.derived.turn, picture: null };
  return turns.first ? [turned, ...pictures] : [...pictures, turned];
}
