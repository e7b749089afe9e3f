//! Names in RAPID: at most 32 letters, digits and `_`, beginning with a letter, the same in upper and lower case, and
//! not used by the language or the system.

/// Most characters of an identifier.
pub(crate) const MAX_NAME: usize = 32;

/// Longest folder: with a slash, a module's name and `.mod` it must fit into a string of 80 characters.
pub(crate) const MAX_FOLDER: usize = 40;

/// Data that the post declares; welddata are `wd1`, `wd2`, …, weavedata `wv1`, …, speeddata of the plain variant `vd1`, ….
pub(crate) const OWN: [&str; 9] = ["jHome", "vHome", "vTravel", "zBead", "smBead", "smLayer", "nStart", "nDz", "main"];

/// Words of the language, and system data and types after which a part might happen to be named.
const RESERVED: &str = "\
    ALIAS AND BACKWARD CASE CONNECT CONST DEFAULT DIV DO ELSE ELSEIF ENDFOR ENDFUNC ENDIF ENDMODULE ENDPROC \
    ENDRECORD ENDTEST ENDTRAP ENDWHILE ERROR EXIT FALSE FOR FROM FUNC GOTO IF INOUT LOCAL MOD MODULE NOSTEPIN \
    NOT NOVIEW OR PERS PROC RAISE READONLY RECORD RETRY RETURN STEP SYSMODULE TASK TEST THEN TO TRAP TRUE \
    TRYNEXT UNDO VAR VIEWONLY WHILE WITH XOR BASE USER FINE STOP BREAK RESET SET POS NUM BOOL STRING POSE \
    VMAX LOAD SAVE ARCL ARCC ARCLSTART ARCLEND ARCCEND MOVEL MOVEJ MOVEC MOVEABSJ SETDO SETAO WAITTIME CONFL CONFJ SINGAREA CIRPATHMODE ACTUNIT \
    UNLOAD ERASEMODULE PTP LIN CIRC BAS IR_STOPM";

/// Families of system names: the letters, then digits only.
const NUMBERED: &str = "V Z TOOL WOBJ LOAD INPOS VROT VLIN LAYER WD WV VD PI";

/// Whether a cell or a part may use the name.
pub(crate) fn is_identifier(name: &str) -> bool {
    let legal = name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_');
    legal && name.len() <= MAX_NAME && name.starts_with(|c: char| c.is_ascii_alphabetic()) && !is_reserved(name)
}

fn is_reserved(name: &str) -> bool {
    let upper = name.to_ascii_uppercase();
    let numbered = |family: &str| upper.strip_prefix(family).is_some_and(|n| n.bytes().all(|b| b.is_ascii_digit()));
    RESERVED.split(' ').any(|word| word == upper) || NUMBERED.split(' ').any(numbered)
}

/// The module name for a part, leaving space for `_L` and `digits`; `taken` are the cell's own names.
pub(super) fn module_name(part: &str, digits: usize, taken: [&str; 2]) -> String {
    let mut name: String = part.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    let taken = OWN.into_iter().chain(taken).any(|own| own.eq_ignore_ascii_case(&name));
    if taken || is_reserved(&name) || !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
        name.insert_str(0, "P_");
    }
    name.truncate(MAX_NAME - 2 - digits);
    name
}

#[cfg(test)]
mod tests {
    use super::{MAX_NAME, is_identifier, module_name};

    #[test]
    fn parts_get_legal_names() {
        let name = |part| module_name(part, 3, ["tTorch", "wPart"]);
        for (part, expected) in [
            ("Test part-1", "Test_part_1"),
            ("7up", "P_7up"),
            ("", "P_"),
            ("Gr\u{fc}n", "Gr_n"),
            ("module", "P_module"),
            ("z5", "P_z5"),
            ("fine", "P_fine"),
            ("WPART", "P_WPART"),
            ("smBead", "P_smBead"),
            ("_x", "P__x"),
        ] {
            assert_eq!(name(part), expected);
        }
        assert_eq!(name(&"a".repeat(99)).len(), MAX_NAME - 5);
    }

    #[test]
    fn system_names_are_no_identifiers() {
        for name in ["tool0", "wobj0", "v100", "V", "z0", "fine", "inpos50", "1a", "a b", "", "Proc", &"x".repeat(33)] {
            assert!(!is_identifier(name), "{name}");
        }
        assert!(["tTorch", "tool_1", "weldgun", "v100b"].iter().all(|name| is_identifier(name)));
    }
}
