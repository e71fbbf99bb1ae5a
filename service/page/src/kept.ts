// What this browser keeps for the page. A browser may forbid that: then nothing is kept, and the page works on.

type Storage = "localStorage" | "sessionStorage";

export function kept(place: string, storage: Storage = "localStorage"): string | null {
  try {
    return globalThis[storage].getItem(place);
  } catch {
    return null;
  }
}

export function keep(place: string, text: string, storage: Storage = "localStorage"): void {
  try {
    globalThis[storage].setItem(place, text);
  } catch {
    // Full or forbidden: it lasts as long as the page.
  }
}
