// All that the page says, in English: one file per area.
import { accuracy } from "./accuracy";
import { answers } from "./answers";
import { products } from "./products";
import { files } from "./files";
import { fit } from "./fit";
import { frame } from "./frame";
import { howto } from "./howto";
import { limbs } from "./limbs";
import { look } from "./look";
import { measure } from "./measure";
import { mask } from "./mask";
import { measures } from "./measures";
import { panel } from "./panel";
import { person } from "./person";
import { points } from "./points";
import { result } from "./result";
import { stage } from "./stage";
import { start } from "./start";
import { trying } from "./trying";

export const messages = { accuracy, answers, files, fit, frame, howto, limbs, look, mask, measure, measures, panel, person, points, products, result, stage, start, trying } as const;
