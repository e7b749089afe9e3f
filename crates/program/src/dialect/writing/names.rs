//! Program names. A program must not have the name of a keyword or of one of the controller's own programs; one list
//! serves all dialects, since a part is often programmed for more than one robot.

/// Words of KRL and of KUKA's own modules.
const KRL: &str = "\
    AND ANIN ANOUT AXIS B_AND B_EXOR B_NOT B_OR BOOL BRAKE CASE CCLOSE CHANNEL CHAR CIRC CIRC_REL CONFIRM CONST CONTINUE \
    COPEN CREAD CWRITE DECL DEF DEFAULT DEFDAT DEFFCT DELAY DIGIN DISTANCE DO E6AXIS E6POS ELSE END ENDDAT ENDFCT ENDFOR \
    ENDIF ENDLOOP ENDSPLINE ENDSWITCH ENDWHILE ENUM EXIT EXOR EXT EXTFCT EXTFCTP EXTP FALSE FOR FRAME GLOBAL GOTO HALT IF \
    IMPORT INT INTERRUPT IS LIN LIN_REL LOOP MAXIMUM MINIMUM NOT OR PATH POS PRIO PTP PTP_REL PUBLIC PULSE REAL REPEAT \
    RESUME RETURN SCIRC SEC SIGNAL SLIN SPL SPLINE SPTP STEP STRUC SWITCH THEN TO TRIGGER TRUE UNTIL VAR WAIT WHEN WHILE \
    WITH BAS BASISTECH CELL FLT_SERV H50 H70 IR_STOPM MASREF_MAIN MSG_DEMO NEW_SERV P00 PERCEPT SPS SPS_USER TMP USER_GRP \
    WEAV_DEF ARC_MAIN ARCMAINNG XHOME";

/// Words of FANUC TP, of INFORM, and names of devices that Windows-based tools refuse as files.
const OTHERS: &str = "\
    ABORT ARCOF ARCON AOUT CALL CNVRT COMMENT DIN DOUT GETS INC JMP JUMP LBL MOVC MOVJ MOVL MOVS NOP OVERRIDE PAUSE PULS RET \
    RUN SET SMOVL TIMER UFRAME UTOOL WEAVE WVOF WVON AUX CON NUL PRN";

/// A name of upper-case letters, digits and `_`, a letter first, that no language reserves.
pub(in crate::dialect) fn upper_name(part: &str) -> String {
    let legal = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_uppercase() } else { '_' };
    let mut name: String = part.chars().map(legal).collect();
    if !name.starts_with(|c: char| c.is_ascii_alphabetic()) || is_reserved(&name) {
        name.insert_str(0, "P_");
    }
    name
}

fn is_reserved(name: &str) -> bool {
    [KRL, OTHERS].iter().flat_map(|words| words.split(' ')).any(|word| word == name)
}

#[cfg(test)]
mod tests {
    use super::upper_name;

    #[test]
    fn words_of_the_languages_are_no_names() {
        for (part, name) in [
            ("ptp", "P_PTP"),
            ("Lin", "P_LIN"),
            ("if", "P_IF"),
            ("BAS", "P_BAS"),
            ("ir_stopm", "P_IR_STOPM"),
            ("MovL", "P_MOVL"),
            ("call", "P_CALL"),
            ("con", "P_CON"),
            ("7-up", "P_7_UP"),
            ("", "P_"),
            ("bracket", "BRACKET"),
            ("lin_1", "LIN_1"),
        ] {
            assert_eq!(upper_name(part), name);
        }
    }
}
