//! The stable names of mistakes, each with the paragraph that explains it.

use serde::Serialize;

macro_rules! codes {
    ($($variant:ident, $name:literal, $explanation:literal;)*) => {
        /// A kind of mistake, by a name that never changes its meaning.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
        pub enum Code {
            $(
                #[doc = $explanation]
                #[serde(rename = $name)]
                $variant,
            )*
        }

        impl Code {
            /// Every code, in the order of the manual.
            pub const ALL: &'static [Code] = &[$(Code::$variant),*];

            /// The name in messages, for example `unknown-kind`.
            pub fn name(self) -> &'static str {
                match self {
                    $(Code::$variant => $name,)*
                }
            }

            /// A paragraph on what is wrong and what to do.
            pub fn explanation(self) -> &'static str {
                match self {
                    $(Code::$variant => $explanation,)*
                }
            }
        }
    };
}

codes! {
    FileNotRead, "file-not-read",
        "A file could not be read: it does not exist, is a folder or a device, or the system \
         refused. The message holds the system's reason. Paths in a recipe start at its folder.";
    NotText, "not-text",
        "A recipe is UTF-8 text. The message names the first byte that is not; a file saved as \
         UTF-16 or a binary file is recognised. Save it again as UTF-8.";
    TooLarge, "too-large",
        "A limit on the size of a recipe was reached: 16 MiB of text, four million \
         values, or 2000 mistakes at once. \
         Nothing was read beyond it.";
    NotARecipe, "not-a-recipe",
        "The file is empty, holds only comments, or holds something other than one pair of \
         parentheses with fields: `(nodes: { .. }, outputs: { .. })`.";
    Syntax, "syntax",
        "The text is not valid RON, the notation of recipes: a comma, colon or value is missing, or \
         there is something that has no meaning. Other mistakes are looked for once the text is valid.";
    Unclosed, "unclosed",
        "A bracket, a string or a comment is opened and never closed. The message points at the \
         opening, since the place where the end is missing cannot be known.";
    NestedTooDeep, "nested-too-deep",
        "Brackets inside brackets may go 64 levels deep, in recipes as in arithmetic, and so may \
         compounds inside compounds. No recipe comes near; a generated file that does should be made of \
         more nodes.";
    UnknownField, "unknown-field",
        "A recipe has the fields about, seed, parameters, nodes and outputs, a compound about, source, \
         version, inputs, nodes and outputs; a parameter has default, range, unit and about, an input \
         of a compound also of, per_point, domain and optional, each where its type allows it. Anything else is refused, since it is \
         most likely a misspelt one.";
    MissingField, "missing-field",
        "A recipe needs the field nodes, a compound an output as well, and a parameter needs a default. There is nothing sensible to \
         assume in their place.";
    DuplicateField, "duplicate-field",
        "A field or an input is written twice in the same parentheses. Which of the two was meant \
         cannot be known, so delete one.";
    DuplicateName, "duplicate-name",
        "Two nodes, two outputs, two parameters or two channels have the same name, or output names \
         differ by case only and would be one file on some systems. Rename one of them.";
    InvalidName, "invalid-name",
        "Names begin with a letter from a to z and go on with letters, digits and underscores: \
         `[a-z][a-z0-9_]*`. Letters of other alphabets may look the same and are not; the message \
         shows the code point.";
    ReservedName, "reserved-name",
        "An output becomes a file, and Windows knows no files called con, prn, aux, nul, com1 to com9 \
         or lpt1 to lpt9. Recipes work on every system, so choose another name.";
    UnknownKind, "unknown-kind",
        "There is no kind of node by that name. `yosegi nodes` lists them. A compound of your own lies in \
         the folder `nodes` in the recipe's folder or beside it, and has the name of its file.";
    NotANode, "not-a-node",
        "The entry is not `name: kind(inputs)`: a node or an output is always an instance of a \
         kind, and a parameter has one of the parameter types.";
    NotAnOutput, "not-an-output",
        "What stands under outputs must give maps, and what gives maps stands under outputs only: \
         that is where images are written.";
    NoOutput, "no-output",
        "The recipe has no output, so there is nothing to render. It can be checked and sampled. Add \
         one: `outputs: { \"name\": maps(of: \"node\") }`.";
    UnknownInput, "unknown-input",
        "The kind or the record has no input by that name. Unknown inputs are refused, since a \
         misspelt one would otherwise silently have its default.";
    MissingInput, "missing-input",
        "An input without a default is left out. `yosegi nodes KIND` shows which are required.";
    TypeMismatch, "type-mismatch",
        "A literal is of another type than the input: text where a number belongs, or a number \
         where a list belongs.";
    WrongLength, "wrong-length",
        "A vector or a colour has three numbers, a pair has two.";
    OutOfRange, "out-of-range",
        "A number is smaller or larger than its input or parameter allows. The range is where the \
         maths holds, so it is not widened silently and the number is not clamped.";
    NotFinite, "not-finite",
        "A number is infinite or not a number: written so, too large for 64 bits, or the result of \
         arithmetic such as a division by zero.";
    InvalidRange, "invalid-range",
        "The range of a parameter must be a pair of numbers, the smaller first, that the default \
         lies in.";
    UnknownChoice, "unknown-choice",
        "The input takes one name out of a short list, and this one is not on it.";
    InvalidColour, "invalid-colour",
        "A colour in quotes is `#rrggbb` with two hexadecimal digits each for red, green and blue, in \
         sRGB; without quotes it is three linear numbers `(r, g, b)`.";
    UnknownUnit, "unknown-unit",
        "A parameter names a unit that no input has. Without a unit it is a plain number.";
    UnitMismatch, "unit-mismatch",
        "A parameter, a link or arithmetic has another unit than the input, or arithmetic adds or compares \
         numbers of different units. Units are never converted silently: multiply or divide by a \
         parameter that has a unit. Numbers written out in arithmetic take the unit of what they are \
         added to, and arithmetic without any unit has that of its input.";
    UnknownParameter, "unknown-parameter",
        "A `$name` in the recipe or a `--set name=value` names a parameter that the recipe does not \
         declare. In text, a dollar sign at the beginning is written `$$`.";
    UnknownNode, "unknown-node",
        "A link names a node that the recipe does not have. In an input that is not text, every \
         string is a link, unless it begins with `$`, `=` or `#`.";
    UnknownOutput, "unknown-output",
        "A link `node.output` names an output that the node's kind does not have.";
    LinkMismatch, "link-mismatch",
        "A link leads to an output of another type than the input takes.";
    LinkNotAllowed, "link-not-allowed",
        "Links stand for a whole input. Inside a list, a tuple or a record, and where a name is chosen, \
         only literals and parameters are allowed, and arithmetic over numbers and parameters.";
    NotConstant, "not-constant",
        "The input must be known before anything is evaluated, and what is linked differs from \
         point to point.";
    SelfLink, "self-link",
        "A node takes one of its own outputs as an input.";
    Cycle, "cycle",
        "Nodes depend on each other in a circle, so none could be evaluated first, or a compound contains \
         itself. The message shows the shortest circle.";
    WrongDomain, "wrong-domain",
        "A solid field is defined at every point of the uncut material, a plane field on a flat \
         piece. The input takes the other one; a cut makes a plane out of a solid.";
    MixedDomains, "mixed-domains",
        "A node takes both a solid and a plane field, so where it is defined would be unclear. Cut \
         the solid first.";
    InvalidArithmetic, "invalid-arithmetic",
        "A string that begins with `=` is arithmetic: numbers, `$parameters`, links, `+ - * /`, \
         parentheses, and min, max, abs, sqrt, clamp, mix and luminance.";
    PathOutside, "path-outside",
        "Files named by a recipe lie in its folder or below, and are written the same on every \
         system: no leading slash, no `..`, no backslash, no colon, nothing that Windows takes for something \
         else. `--allow-outside` lets a recipe name any file.";
    InvalidEdit, "invalid-edit",
        "An edit of a recipe's text cannot be made: what is to be removed is not written, or what is to be \
         deleted is still used. The text stays as it is.";
    UnusedNode, "unused-node",
        "No output depends on the node, so it is never evaluated. This is a warning.";
    UnusedParameter, "unused-parameter",
        "Nothing in the recipe refers to the parameter, so setting it changes nothing. This is a \
         warning.";
    OutputNotWritten, "output-not-written",
        "A map could not be written: the folder does not exist and cannot be made, the disk is full, or \
         the system refused. What was there before is still whole.";
    OutputOverInput, "output-over-input",
        "A map would replace the recipe, a file that the recipe reads, or a file in the store of earlier \
         results. Nothing was rendered. Choose another folder or another name for the output.";
    CacheMismatch, "cache-mismatch",
        "A result that was made again, as `--verify-cache` asks, is not the one that a cache had for the same \
         inputs: a kind gives other results than before under the same version, or the store was tampered with. \
         The entry was replaced. Whoever has changed a kind raises its version.";
    TooMuch, "too-much",
        "The maps asked for, the programs that compute them, or the nodes inside compounds are more than a \
         limit on one run. The message names the limit, and the switch that raises it or what would keep \
         below it.";
    NodeFailed, "node-failed",
        "A node could not be built from its inputs although each of them is valid. Nodes that depend \
         on it are skipped; everything else is still rendered.";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_the_same_in_json() {
        let mut names: Vec<_> = Code::ALL.iter().map(|code| code.name()).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), Code::ALL.len());
        for code in Code::ALL {
            let json = serde_json::to_string(code).unwrap();
            assert_eq!(json, format!("\"{}\"", code.name()));
            let is_kebab = |letter: char| letter.is_ascii_lowercase() || letter == '-';
            assert!(code.name().chars().all(is_kebab), "{json}");
            assert!(code.explanation().ends_with('.') && !code.explanation().contains("  "));
        }
    }
}
