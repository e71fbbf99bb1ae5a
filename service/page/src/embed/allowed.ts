// What whoever looks at a result may do with it: everything on this page, in a frame what the site says.
import { signal } from "@preact/signals";
import { isEmbedded } from "../route";

const allowed = signal<readonly Maquette.Deed[]>([]);

export function allow(deeds: readonly Maquette.Deed[]): void {
  allowed.value = deeds;
}

export function may(deed: Maquette.Deed): boolean {
  return !isEmbedded || allowed.value.includes(deed);
}
