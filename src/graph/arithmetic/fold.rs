//! What operators and functions make of numbers.

use crate::graph::{Arithmetic, Function, Link, Operator};

impl Arithmetic {
    /// A number, if all parts are numbers.
    pub(super) fn fold(self) -> Arithmetic {
        use Arithmetic::{Binary, Call, Negate, Number};
        match &self {
            Negate(of) => match **of {
                Number(number) => Number(-number),
                _ => self,
            },
            Binary(operator, parts) => match **parts {
                [Number(a), Number(b)] => Number(operator.apply(a, b)),
                _ => self,
            },
            Call(function, arguments) => {
                let numbers: Option<Vec<f64>> =
                    arguments.iter().map(Arithmetic::as_number).collect();
                numbers
                    .and_then(|numbers| function.apply(&numbers))
                    .map_or(self, Number)
            }
            _ => self,
        }
    }

    /// Whether it is a number divided by 0.
    pub(super) fn divides_by_zero(&self) -> bool {
        let Arithmetic::Binary(Operator::Divide, parts) = self else {
            return false;
        };
        matches!(**parts, [Arithmetic::Number(_), Arithmetic::Number(0.0)])
    }

    /// The number that it gives if `number_of` knows every link.
    pub fn constant(&self, number_of: &dyn Fn(&Link) -> Option<f64>) -> Option<f64> {
        let constant = |inner: &Arithmetic| inner.constant(number_of);
        match self {
            Arithmetic::Number(number) => Some(*number),
            Arithmetic::Link(link) => number_of(link),
            Arithmetic::Negate(of) => Some(-constant(of)?),
            Arithmetic::Binary(operator, parts) => {
                let [a, b] = &**parts;
                Some(operator.apply(constant(a)?, constant(b)?))
            }
            Arithmetic::Call(function, arguments) => {
                let numbers: Option<Vec<f64>> = arguments.iter().map(constant).collect();
                function.apply(&numbers?)
            }
        }
    }

    /// Operators above its deepest part, and the number of all parts.
    pub(in crate::graph) fn measure(&self) -> (usize, usize) {
        use Arithmetic::{Binary, Call, Link, Negate, Number};
        let parts: &[Arithmetic] = match self {
            Number(_) | Link(_) => return (0, 1),
            Negate(of) => std::slice::from_ref(of),
            Binary(_, parts) => &**parts,
            Call(_, parts) => parts,
        };
        let parts = parts.iter().map(Arithmetic::measure);
        parts.fold((1, 1), |(depth, size), part| {
            (depth.max(part.0 + 1), size + part.1)
        })
    }

    pub(super) fn as_number(&self) -> Option<f64> {
        match self {
            Arithmetic::Number(number) => Some(*number),
            _ => None,
        }
    }
}

impl Operator {
    /// What it makes of two numbers.
    pub(super) fn apply(self, a: f64, b: f64) -> f64 {
        match self {
            Operator::Add => a + b,
            Operator::Subtract => a - b,
            Operator::Multiply => a * b,
            Operator::Divide => a / b,
        }
    }
}

impl Function {
    /// Every function.
    pub const ALL: [Function; 7] = [
        Function::Min,
        Function::Max,
        Function::Abs,
        Function::Sqrt,
        Function::Clamp,
        Function::Mix,
        Function::Luminance,
    ];

    /// The name in recipes.
    pub fn name(self) -> &'static str {
        ["min", "max", "abs", "sqrt", "clamp", "mix", "luminance"][self as usize]
    }

    /// The function called `name`.
    pub fn from_name(name: &str) -> Option<Function> {
        Function::ALL
            .into_iter()
            .find(|function| function.name() == name)
    }

    /// Numbers that it takes.
    pub fn arguments(self) -> usize {
        match self {
            Function::Abs | Function::Sqrt | Function::Luminance => 1,
            Function::Min | Function::Max => 2,
            Function::Clamp | Function::Mix => 3,
        }
    }

    /// What it makes of numbers; luminance is of colours.
    pub(super) fn apply(self, numbers: &[f64]) -> Option<f64> {
        Some(match (self, numbers) {
            (Function::Min, [a, b]) => a.min(*b),
            (Function::Max, [a, b]) => a.max(*b),
            (Function::Abs, [a]) => a.abs(),
            (Function::Sqrt, [a]) => a.max(0.0).sqrt(),
            (Function::Clamp, [a, low, high]) => a.max(*low).min(*high),
            (Function::Mix, [a, b, amount]) => a + (b - a) * amount,
            _ => return None,
        })
    }
}
