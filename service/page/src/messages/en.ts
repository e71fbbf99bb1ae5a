// English: the pattern for other languages.
import { accuracy } from "./en/accuracy";
import { answers } from "./en/answers";
import { derived } from "./en/derived";
import { embed } from "./en/embed";
import { files } from "./en/files";
import { fit } from "./en/fit";
import { frame } from "./en/frame";
import { howto } from "./en/howto";
import { limbs } from "./en/limbs";
import { look } from "./en/look";
import { measure } from "./en/measure";
import { mask } from "./en/mask";
import { measures } from "./en/measures";
import { panel } from "./en/panel";
import { people } from "./en/people";
import { person } from "./en/person";
import { points } from "./en/points";
import { result } from "./en/result";
import { stage } from "./en/stage";
import { start } from "./en/start";

export const en = { accuracy, answers, derived, embed, files, fit, frame, howto, limbs, look, mask, measure, measures, panel, people, person, points, result, stage, start } as const;
