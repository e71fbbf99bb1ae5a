// Escape takes back the last thing that stands out: the first of these steps that has something to take back.
import { useEffect, useRef } from "preact/hooks";

type Step = readonly [isDue: boolean, takeBack: () => void];

export function useEscape(steps: readonly Step[]): void {
  const due = useRef(steps);
  due.current = steps;
  useEffect(() => {
    const hear = (event: KeyboardEvent) => {
      // An open dialog closes by it, and nothing else.
      if (event.key !== "Escape" || event.defaultPrevented || document.querySelector("dialog[open]")) return;
      const step = due.current.find(([isDue]) => isDue);
      step?.[1]();
    };
    addEventListener("keydown", hear);
    return () => removeEventListener("keydown", hear);
  }, []);
}
