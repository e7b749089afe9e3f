//! Beads as an Apache Parquet table: the columns of the CSV table, for pandas, Polars, DuckDB and Arrow; and other tables.

use super::table::{COUNTS, KIND, measures};
use super::{Beads, ExportError, Format};
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int32Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{Type, TypePtr};
use std::ops::Range;
use std::sync::Arc;

pub(super) const FORMAT: Format =
    Format { extension: "parquet", purpose: "a table of all pieces, for pandas, Polars and DuckDB", write };

/// Number of rows that are written together.
const GROUP: usize = 1 << 20;

/// The values of a column in some rows.
pub(crate) enum Values {
    Counts(Vec<i32>),
    Texts(Vec<ByteArray>),
    Numbers(Vec<f64>),
}

/// A column: its name, and its values in a range of rows.
pub(crate) struct Field<'a> {
    pub(crate) name: &'a str,
    pub(crate) values: Box<dyn Fn(Range<usize>) -> Values + 'a>,
}

fn write(beads: &Beads<'_>) -> Result<Vec<u8>, ExportError> {
    let pieces = &beads.pieces();
    let counts = COUNTS.iter().map(|(name, count)| {
        let values =
            move |rows: Range<usize>| Values::Counts(pieces[rows].iter().map(|piece| count(piece) as i32).collect());
        Field { name, values: Box::new(values) }
    });
    let kinds = |rows: Range<usize>| Values::Texts(pieces[rows].iter().map(|piece| piece.kind.name().into()).collect());
    let kind = Field { name: KIND, values: Box::new(kinds) };
    let measures = measures(beads).into_iter().map(|column| {
        let values = move |rows: Range<usize>| Values::Numbers(pieces[rows].iter().map(column.value).collect());
        Field { name: column.name, values: Box::new(values) }
    });
    let fields: Vec<Field<'_>> = counts.chain([kind]).chain(measures).collect();
    Ok(table("pieces", pieces.len(), &fields)?)
}

/// A table with this name and these columns.
pub(crate) fn table(name: &str, rows: usize, fields: &[Field<'_>]) -> Result<Vec<u8>, ParquetError> {
    let properties =
        WriterProperties::builder().set_created_by(concat!("Beadwright ", env!("CARGO_PKG_VERSION")).to_owned());
    let mut writer = SerializedFileWriter::new(Vec::new(), schema(name, fields)?, Arc::new(properties.build()))?;
    for begin in (0..rows).step_by(GROUP) {
        let mut group = writer.next_row_group()?;
        columns(&mut group, begin..(begin + GROUP).min(rows), fields)?;
        group.close()?;
    }
    writer.into_inner()
}

fn schema(name: &str, fields: &[Field<'_>]) -> Result<TypePtr, ParquetError> {
    let field = |field: &Field<'_>| {
        let (kind, meaning) = match (field.values)(0..0) {
            Values::Counts(_) => (Physical::INT32, None),
            Values::Texts(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
            Values::Numbers(_) => (Physical::DOUBLE, None),
        };
        let field = Type::primitive_type_builder(field.name, kind).with_repetition(Repetition::REQUIRED);
        field.with_logical_type(meaning).build().map(Arc::new)
    };
    let fields = fields.iter().map(field).collect::<Result<Vec<_>, _>>()?;
    Type::group_type_builder(name).with_fields(fields).build().map(Arc::new)
}

/// Writes the columns of some rows, in the order of the schema.
fn columns(
    group: &mut SerializedRowGroupWriter<'_, Vec<u8>>,
    rows: Range<usize>,
    fields: &[Field<'_>],
) -> Result<(), ParquetError> {
    for field in fields {
        let Some(mut column) = group.next_column()? else { break };
        match (field.values)(rows.clone()) {
            Values::Counts(values) => column.typed::<Int32Type>().write_batch(&values, None, None)?,
            Values::Texts(values) => column.typed::<ByteArrayType>().write_batch(&values, None, None)?,
            Values::Numbers(values) => column.typed::<DoubleType>().write_batch(&values, None, None)?,
        };
        column.close()?;
    }
    Ok(())
}
