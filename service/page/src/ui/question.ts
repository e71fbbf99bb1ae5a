// A question in place of what asked it: it begins at the answer that changes nothing, which Escape gives as well.
import { useEffect, useRef, useState } from "preact/hooks";
import type { Ref } from "preact";

export interface Question {
  readonly isAsked: boolean;
  readonly ask: () => void;
  readonly leave: () => void;
  /** The button that asks: it has the focus again once nothing is asked. */
  readonly asker: Ref<HTMLButtonElement>;
  /** The button that changes nothing. */
  readonly refusal: Ref<HTMLButtonElement>;
}

export function useQuestion(): Question {
  const [isAsked, setAsked] = useState(false);
  const asker = useRef<HTMLButtonElement>(null);
  const refusal = useRef<HTMLButtonElement>(null);
  const wasAsked = useRef(false);
  useEffect(() => {
    if (isAsked) refusal.current?.focus();
    else if (wasAsked.current) asker.current?.focus();
    wasAsked.current = isAsked;
    if (!isAsked) return undefined;
    const follow = (event: KeyboardEvent) => {
      if (event.key === "Escape") setAsked(false);
    };
    addEventListener("keydown", follow);
    return () => removeEventListener("keydown", follow);
  }, [isAsked]);
  return { isAsked, ask: () => setAsked(true), leave: () => setAsked(false), asker, refusal };
}
