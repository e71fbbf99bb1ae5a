// What was asked for in a fit or scan.
import { useEffect, useState } from "preact/hooks";

/** Null until it is there; without it everything else is shown all the same. */
export function useAsked<T>(id: string, get: () => Promise<T>): T | null {
  const [asked, setAsked] = useState<T | null>(null);
  useEffect(() => {
    let gone = false;
    get().then(
      (found) => gone || setAsked(found),
      () => undefined,
    );
    return () => {
      gone = true;
    };
  }, [id]);
  return asked;
}
